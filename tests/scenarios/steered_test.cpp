// Obstacles and pins that a program throws as far in a step as it may: nothing passes.
#include "base/error.h"
#include "network/network_builder.h"
#include "scenarios/judge.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace sprung::testing {
namespace {

enum class Body : std::uint8_t { cloth, rope, jelly };
enum class Thrown : std::uint8_t { sphere, box, capsule, mesh, sheet };

constexpr double kSize = 0.5;     // of each body, along its longest side [m]
constexpr double kRadius = 0.05;  // of obstacles [m]
constexpr int kThrows = 12;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double within(double least, double most) { return std::uniform_real_distribution<>(least, most)(engine_); }
  Vector3 point(double half) { return {within(-half, half), within(-half, half), within(-half, half)}; }

 private:
  std::mt19937_64 engine_;
};

/// A body that hangs from a pin of one or two corners, or of its top, around the origin.
SpringNetwork hanging(Body body) {
  const SpringMaterial limp{.value = 0.0};
  const SpringMaterial soft{.value = 20.0, .damping = 0.05};
  BodyShape shape;
  std::vector<Index> held{0};
  if (body == Body::cloth) {
    shape = make_cloth({.size = {kSize, kSize}, .resolution = {16, 16}}, {.structural = limp, .shear = limp});
    held = {240, 255};
  } else if (body == Body::rope) {
    shape =
        make_rope({.points = {{0.0, kSize / 2, 0.0}, {0.0, -kSize / 2, 0.0}}, .particles = 26, .length = {}}, {.structural = limp});
  } else {
    shape = make_solid({.size = {0.2, kSize, 0.2}, .resolution = {4, 9, 4}}, {.structural = soft, .shear = soft});
    held = {32, 33, 34, 35};  // along its upper edge
  }
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("body", shape, {.thickness = 0.003, .friction = 0.3, .static_friction = 0.3});
  builder.pin(held);
  return builder.build();
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = kRadius * (Points(3, 4) << 1, -1, -1, 1, 1, -1, 1, -1, 1, 1, -1, -1).finished();
  mesh.triangles = (Triangles(3, 4) << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3).finished();
  return mesh;
}

TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices = 2.0 * kRadius * (Points(3, 4) << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0).finished();
  mesh.triangles = (Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished();
  return mesh;
}

ObstacleGeometry geometry_of(Thrown thrown) {
  switch (thrown) {
    case Thrown::sphere:
      return SphereGeometry{.radius = kRadius};
    case Thrown::box:
      return BoxGeometry{.size = Vector3::Constant(2.0 * kRadius)};
    case Thrown::capsule:
      return CapsuleGeometry{.radius = kRadius / 2, .length = 4.0 * kRadius};
    case Thrown::mesh:
      return MeshGeometry{.mesh = std::make_shared<TriangleMesh>(tetrahedron()), .closed = true};
    default:
      return MeshGeometry{.mesh = std::make_shared<TriangleMesh>(square())};
  }
}

SimulatorSettings settings_of(Body body, double step) {
  SimulatorSettings settings{.step = step};
  if (body == Body::jelly) {
    settings.integrator = ImplicitEulerSettings{};
  } else {
    settings.stretch_limit = StretchLimitSettings{.max_stretch = 0.02};
  }
  return settings;
}

/// What the judge finds in a run.
struct Findings {
  Index inside = 0;
  Index crossings = 0;
  Index infeasible = 0;
  int steps = 0;
  bool diverged = false;
};
std::ostream& operator<<(std::ostream& stream, const Findings& found) {
  return stream << found.inside << " inside, " << found.crossings << " crossings, " << found.infeasible << " infeasible in "
                << found.steps << " steps" << (found.diverged ? ", then diverged" : "");
}

/// A jelly may diverge: it is thrown at 30 m/s and more.
void expect_free(const Findings& found, Body body, std::uint64_t seed) {
  EXPECT_EQ(found.inside + found.crossings, 0) << "seed " << seed << ": " << found;
  EXPECT_EQ(found.infeasible, 0) << "seed " << seed << ": " << found;
  EXPECT_TRUE(!found.diverged || body == Body::jelly) << "seed " << seed << ": " << found;
}

class JudgedSteps {
 public:
  explicit JudgedSteps(Simulator& simulator)
      : simulator_(simulator),
        elements_(judged_elements(simulator.network())),
        judge_(judge_of(simulator.obstacles()[0].geometry)) {}

  /// Makes a step. Returns whether it diverged, which a program is told.
  bool step() {
    try {
      found.infeasible += simulator_.step().infeasible;
    } catch (const StepError&) {
      found.diverged = true;
      return true;
    }
    ++found.steps;
    const Points local = simulator_.obstacle_pose(0).inverse() * simulator_.positions();
    found.inside += judge_->count_inside(local);
    found.crossings += judge_->count_crossings(elements_, local);
    return false;
  }

  Findings found;

 private:
  Simulator& simulator_;
  std::vector<JudgedElement> elements_;
  std::unique_ptr<const ObstacleJudge> judge_;
};

/// Moves the pose towards a target, in as many steps as the refusal says.
template <class Move>
bool go(JudgedSteps& steps, const RigidTransform& present, const RigidTransform& target, const Move& move) {
  int count = 1;
  try {
    move(target);
  } catch (const InputError& error) {
    const std::string& remedy = error.problems()[0].remedy;
    count = std::stoi(remedy.substr(remedy.find("in ") + 3));
  }
  const Motion path{.poses = {{0.0, present}, {1.0, target}}};
  for (int k = 1; k <= count; ++k) {
    move(path.pose(present, static_cast<double>(k) / count));
    if (steps.step()) return false;
  }
  return true;
}

RigidTransform pose_of(const Vector3& position, const Vector3& axis, double angle) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

class Steered : public ::testing::TestWithParam<std::tuple<Body, Thrown, double>> {
 protected:
  [[nodiscard]] static Obstacle obstacle_at(const Vector3& position) {
    Obstacle thrown{.name = "thrown", .geometry = geometry_of(std::get<1>(GetParam()))};
    thrown.rest_pose.translation() = position;
    thrown.material = {.thickness = 0.001, .friction = 0.3, .static_friction = 0.3};
    return thrown;
  }
};
INSTANTIATE_TEST_SUITE_P(Body, Steered,
                         ::testing::Combine(::testing::Values(Body::cloth, Body::rope, Body::jelly),
                                            ::testing::Values(Thrown::sphere, Thrown::box, Thrown::capsule, Thrown::mesh,
                                                              Thrown::sheet),
                                            ::testing::Values(1.0 / 60.0, 1.0 / 960.0)));

// Each throw goes through the place of the body, to a random point around it, with any rotation.
TEST_P(Steered, NothingPassesAThrownObstacle) {
  const auto [body, thrown, step] = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    Simulator simulator(hanging(body), settings_of(body, step), {obstacle_at({0.0, 0.0, 0.6 * kSize})});
    JudgedSteps steps(simulator);
    for (int k = 0; k < kThrows; ++k) {
      Vector3 position = random.point(0.6 * kSize);
      position.y() = random.within(-0.5, 0.1) * kSize;  // what is pinned does not give way to an obstacle
      position.z() += k % 2 == 0 ? -0.6 * kSize : 0.6 * kSize;
      const RigidTransform target = pose_of(position, random.point(1.0), random.within(0.0, std::numbers::pi));
      if (!go(steps, simulator.obstacle_pose(0), target, [&](const RigidTransform& pose) { simulator.move_obstacle(0, pose); }))
        break;
    }
    expect_free(steps.found, body, seed);
  }
}

// The hand stays on one side of the obstacle, above it, and throws the body over it and around it.
TEST_P(Steered, NothingPassesWhenAPinThrowsTheBody) {
  const auto [body, thrown, step] = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    Simulator simulator(hanging(body), settings_of(body, step), {obstacle_at({0.0, 0.0, 0.35 * kSize})});
    JudgedSteps steps(simulator);
    const RigidTransform start = simulator.pin_pose(0);
    for (int k = 0; k < kThrows; ++k) {
      Vector3 by = random.point(0.6 * kSize);
      by.y() = std::abs(by.y());
      const RigidTransform target = RigidTransform(Eigen::Translation3d(by)) * start;
      if (!go(steps, simulator.pin_pose(0), target, [&](const RigidTransform& pose) { simulator.move_pin(0, pose); })) break;
    }
    expect_free(steps.found, body, seed);
  }
}

}  // namespace
}  // namespace sprung::testing
