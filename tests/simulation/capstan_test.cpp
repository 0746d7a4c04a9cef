// Ropes, cloths and solids over a drum: they rest without creeping, and slide where the capstan equation says.
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

/// The tension at the long side that slides a body, in weights of the arm: T' = cos a + mu (T + sin a) over half a turn, from
/// the weight of the short side (capstan equation with the body's own weight). The weight of a thick body acts at the `middle` of
/// its thickness, and friction at the surface: mu becomes mu kArm / middle.
double largest_load(double friction, double middle) {
  const double mu = friction * kArm / middle;
  const double square = mu * mu;
  const double particular = -2.0 * mu / (1.0 + square);
  return (kShort / middle - particular) * std::exp(mu * std::numbers::pi) - particular;
}

double critical_friction(double middle) {
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k < 50; ++k) {
    const double friction = 0.5 * (low + high);
    (largest_load(friction, middle) * middle < kLong ? low : high) = friction;
  }
  return low;
}

constexpr int kArc = 32;

BodyShape rope_over_drum() {
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
  return shape;
}

/// Lays a strip along x, whose lower side is at y = 0, over the drum, and lets its springs rest there.
void lay_over_drum(BodyShape& strip, double middle) {
  const double arc = std::numbers::pi * middle;
  for (Vector3& position : strip.positions) {
    const double along = position.x() + 0.5 * (kShort + arc + kLong);
    const double angle = std::numbers::pi * (1.0 - std::clamp((along - kShort) / arc, 0.0, 1.0));
    const double hangs = std::max({0.0, kShort - along, along - kShort - arc});
    position = (kArm + position.y()) * Vector3(std::cos(angle), std::sin(angle), 0.0) + Vector3(0.0, -hangs, position.z());
  }
  for (Index s = 0; s < strip.springs.count(); ++s) {
    strip.springs.rest_length[s] = (strip.positions[strip.springs.first[s]] - strip.positions[strip.springs.second[s]]).norm();
  }
}

SpringMaterials strip_springs(double modulus) {
  SpringMaterial elastic{.value = modulus, .damping_time = 2.0e-4};
  elastic.measure = SpringMaterial::Measure::modulus;
  return {.structural = elastic, .shear = elastic};
}

BodyShape cloth_over_drum() {
  constexpr double kLength = kShort + kLong + std::numbers::pi * kArm;
  BodyShape shape = make_cloth({.size = {kLength, 0.06}, .resolution = {100, 4}}, strip_springs(1000.0));
  for (Vector3& position : shape.positions) position = Vector3(position.x(), 0.0, position.y());
  set_density(shape, 1.0);
  lay_over_drum(shape, kArm);
  return shape;
}

// It is thin: the moment that bends it over the drum is a hundredth of its weight's.
constexpr double kLayer = 0.003;  // [m]

BodyShape solid_over_drum() {
  constexpr double kMiddle = kArm + 0.5 * kLayer;
  BodyShape shape = make_solid({.size = {kShort + kLong + std::numbers::pi * kMiddle, kLayer, 0.06}, .resolution = {100, 2, 2}},
                               strip_springs(1.0e6));
  for (Vector3& position : shape.positions) position.y() += 0.5 * kLayer;
  set_density(shape, 1000.0);
  lay_over_drum(shape, kMiddle);
  return shape;
}

struct Drum {
  const char* name;
  ObstacleGeometry geometry;
  IntegratorSettings scheme;
  BodyShape (*body)() = rope_over_drum;
  double middle = kArm;  ///< radius of the middle of the body [m]
};

void PrintTo(const Drum& drum, std::ostream* stream) { *stream << drum.name; }

/// The distance [m] that the long end sinks in the second after gravity has grown from 0 to its full value in a second: the springs
/// then hardly swing.
double sunk(const Drum& drum, double friction) {
  Obstacle obstacle{.name = "drum", .geometry = drum.geometry, .material = {.friction = friction, .static_friction = friction}};
  obstacle.rest_pose.linear() = rotation_from_degrees({90.0, 0.0, 0.0});
  const bool is_implicit = std::holds_alternative<ImplicitEulerSettings>(drum.scheme);
  NetworkBuilder builder;
  builder.add_body("body", drum.body(), {.thickness = kThickness, .friction = friction, .static_friction = friction});
  Simulator simulator(
      builder.build(),
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
          {"ellipsoid, implicit Euler", ellipsoid, implicit},
          {"cylinder, implicit Euler, cloth", cylinder, implicit, cloth_over_drum},
          {"cylinder, implicit Euler, solid", cylinder, implicit, solid_over_drum, kArm + 0.5 * kLayer}};
}

class Capstan : public ::testing::TestWithParam<Drum> {};
INSTANTIATE_TEST_SUITE_P(Drums, Capstan, ::testing::ValuesIn(drums()));

// 0.1 mm/s.
TEST_P(Capstan, ABodyRestsWithoutCreeping) { EXPECT_LT(std::abs(sunk(GetParam(), 0.3)), 1.0e-4); }

// A body that slides has more and more weight on its long side.
TEST_P(Capstan, FrictionIsRightToFivePerCent) {
  EXPECT_LT(std::abs(sunk(GetParam(), 1.05 * critical_friction(GetParam().middle))), 1.0e-3);
  EXPECT_GT(sunk(GetParam(), 0.95 * critical_friction(GetParam().middle)), 1.0e-2);
}

}  // namespace
}  // namespace sprung
