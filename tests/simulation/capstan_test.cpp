// A rope over a drum: it rests without creeping, and slides where the capstan equation says.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

namespace sprung {
namespace {

constexpr double kRadius = 0.1;       // [m] of the drum
constexpr double kThickness = 0.005;  // [m] of the rope
constexpr double kShort = 0.4;        // [m] that hangs down on one side
constexpr double kLong = 0.9;         // [m] on the other side
constexpr double kArm = kRadius + kThickness;

/// The tension at the long side that slides the rope, in weights of the arm: T' = cos a + mu (T + sin a) over half a turn, from
/// the weight of the short side (capstan equation with the rope's own weight).
double largest_load(double friction) {
  const double square = friction * friction;
  const double particular = -2.0 * friction / (1.0 + square);
  return (kShort / kArm - particular) * std::exp(friction * std::numbers::pi) - particular;
}

double critical_friction() {
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (largest_load(middle) * kArm < kLong ? low : high) = middle;
  }
  return low;
}

SpringNetwork rope_over_drum(double friction) {
  constexpr int kArc = 32;
  RopeShape rope{.points = {{-kArm, -kShort, 0.0}}, .particles = 160, .length = {}};
  for (int k = 0; k <= kArc; ++k) {
    const double angle = std::numbers::pi * (1.0 - static_cast<double>(k) / kArc);
    rope.points.push_back(kArm * Vector3(std::cos(angle), std::sin(angle), 0.0));
  }
  rope.points.emplace_back(kArm, -kLong, 0.0);
  SpringMaterial elastic{.value = 300.0, .damping = 0.05};
  elastic.measure = SpringMaterial::Measure::modulus;
  BodyShape shape = make_rope(rope, {.structural = elastic});
  set_density(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape, {.thickness = kThickness, .friction = friction, .static_friction = friction});
  return builder.build();
}

struct Drum {
  const char* name;
  ObstacleGeometry geometry;
  IntegratorSettings scheme;
};

void PrintTo(const Drum& drum, std::ostream* stream) { *stream << drum.name; }

/// The distance [m] that the long end sinks in the second after gravity has grown from 0 to its full value in a second: the springs
/// then hardly swing.
double sunk(const Drum& drum, double friction) {
  Obstacle obstacle{.name = "drum", .geometry = drum.geometry, .material = {.friction = friction, .static_friction = friction}};
  obstacle.rest_pose.linear() = rotation_from_degrees({90.0, 0.0, 0.0});
  const bool is_implicit = std::holds_alternative<ImplicitEulerSettings>(drum.scheme);
  Simulator simulator(
      rope_over_drum(friction),
      {.step = is_implicit ? 1.0 / 240.0 : 1.0 / 7680.0, .gravity = Vector3::Zero(), .integrator = drum.scheme, .sleep = false},
      {obstacle});
  constexpr int kRamp = 60;
  for (int k = 1; k <= kRamp; ++k) {
    simulator.set_gravity({0.0, -testing::kGravity * k / kRamp, 0.0});
    testing::run(simulator, 1.0 / kRamp);
  }
  const double begin = simulator.positions().row(1).minCoeff();
  testing::run(simulator, 1.0);
  return begin - simulator.positions().row(1).minCoeff();
}

std::vector<Drum> drums() {
  const CylinderGeometry cylinder{.radius = kRadius, .height = 0.3};
  const EllipsoidGeometry ellipsoid{.radii = {kRadius, 0.3, kRadius}};
  const VerletSettings verlet{.damping_rate = 5.0};
  const ImplicitEulerSettings implicit{};
  return {{"cylinder", cylinder, verlet},
          {"capsule", CapsuleGeometry{.radius = kRadius, .length = 0.3}, verlet},
          {"ellipsoid", ellipsoid, verlet},
          {"cylinder, implicit Euler", cylinder, implicit},
          {"ellipsoid, implicit Euler", ellipsoid, implicit}};
}

class Capstan : public ::testing::TestWithParam<Drum> {};
INSTANTIATE_TEST_SUITE_P(Drums, Capstan, ::testing::ValuesIn(drums()));

// 0.1 mm/s.
TEST_P(Capstan, ARopeRestsWithoutCreeping) { EXPECT_LT(std::abs(sunk(GetParam(), 0.3)), 1.0e-4); }

// A rope that slides has more and more weight on its long side.
TEST_P(Capstan, FrictionIsRightToFivePerCent) {
  EXPECT_LT(std::abs(sunk(GetParam(), 1.05 * critical_friction())), 1.0e-3);
  EXPECT_GT(sunk(GetParam(), 0.95 * critical_friction()), 1.0e-2);
}

}  // namespace
}  // namespace sprung
