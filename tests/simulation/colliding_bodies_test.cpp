// Bodies that collide exchange momentum and gain no energy, also where truncation stops motion that contact did not detect.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace sprung {
namespace {

using testing::kGravity;

constexpr ContactMaterial kThin{.thickness = 0.005};

/// A level cloth with springs of `stiffer` times 200 N/m.
BodyShape level_cloth(double size, Index n, double stiffer, double damping) {
  BodyShape shape = make_cloth({.size = {size, size}, .resolution = {n, n}},
                               {.structural = SpringMaterial{.value = 200.0 * stiffer, .damping = damping},
                                .shear = SpringMaterial{.value = 120.0 * stiffer, .damping = damping}});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({90.0, 0.0, 0.0});
  place(shape, pose, Vector3::Zero());
  return shape;
}

BodyShape cube(double size, double mass, double stiffness, double damping, const Vector3& rotation, const Vector3& position,
               const Vector3& velocity) {
  BodyShape shape = make_solid({.size = Vector3::Constant(size), .resolution = {2, 2, 2}},
                               {.structural = SpringMaterial{.value = stiffness, .damping = damping},
                                .shear = SpringMaterial{.value = 0.6 * stiffness, .damping = damping}});
  set_total_mass(shape, mass);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(rotation);
  pose.translation() = position;
  place(shape, pose, velocity);
  return shape;
}

// Truncation clips each body separately and does not conserve momentum. It may remove a fifth of the momentum here. A cube that
// stopped in mid-air would lose all of it.
TEST(CollidingBodies, ACubeThatHitsALightClothKeepsTheirMomentum) {
  NetworkBuilder builder;
  builder.add_body("cube", cube(0.3, 1.0, 800.0, 0.02, {10.0, 30.0, 20.0}, {0.1, 0.4, 0.05}, {0.0, -3.0, 0.0}), kThin);
  builder.add_body("cloth", level_cloth(0.6, 14, 1.0, 0.02), kThin);
  const SpringNetwork network = builder.build();
  Simulator simulator(network, {.step = 1.0 / 960.0, .gravity = Vector3::Zero()});
  testing::run(simulator, 0.5);
  const Vector3 momentum = simulator.state().v * network.masses;
  EXPECT_LT((momentum - Vector3(0.0, -3.0, 0.0)).norm(), 0.2 * 3.0) << momentum.transpose();
}

constexpr double kBlock = 20.0;  // [kg]

/// A block above a hammock, which is 0.25 m above a floor.
SpringNetwork block_above_hammock() {
  NetworkBuilder builder;
  const Index first = builder.add_body("cloth", level_cloth(0.8, 10, 13.0, 0.5), kThin);
  builder.pin({first, first + 9, first + 90, first + 99});
  builder.add_body("block", cube(0.2, kBlock, 20000.0, 40.0, {0.0, 13.0, 0.0}, {0.01, 0.25, 0.02}, Vector3::Zero()), kThin);
  return builder.build();
}

/// The largest rise [J] within a second of the kinetic, gravity and elastic energy over its smallest previous value.
double largest_rise(const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles) {
  Simulator simulator(block_above_hammock(), settings, obstacles);
  const SpringNetwork& network = simulator.network();
  double least = std::numeric_limits<double>::infinity();
  double rise = 0.0;
  for (double time = 0.0; time < 1.0; time += settings.step) {
    simulator.step();
    const double energy = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) +
                          simulator.gravity_energy() + simulator.elastic_energy();
    least = std::min(least, energy);
    rise = std::max(rise, energy - least);
  }
  return rise;
}

// The energy that contacts add depends on which elements touch in a step. So the largest value of several step sizes counts. Over
// twelve step sizes it was at most 0.7 J, and 4 J where each body was stopped separately.
double largest_rise_of_steps(const std::optional<StretchLimitSettings>& limit, const std::vector<Obstacle>& obstacles = {}) {
  double largest = 0.0;
  for (const double rate : {3000.0, 3500.0, 4000.0, 6000.0}) {
    largest = std::max(largest, largest_rise({.step = 1.0 / rate, .stretch_limit = limit}, obstacles));
  }
  return largest;
}

// A hundredth of the energy of the fall from the hammock to the full length of its links.
constexpr double kFall = 0.5;                                 // [m]
constexpr double kLittle = 0.01 * kBlock * kGravity * kFall;  // [J]

TEST(CollidingBodies, AHeavyBlockOnAClothIsNotThrownUp) { EXPECT_LT(largest_rise_of_steps(std::nullopt), kLittle); }

// The passes of the limit start from the positions after the bodies were separated and obstacles were resolved.
TEST(CollidingBodies, AHeavyBlockOnAClothAboveAFloorIsNotThrownUp) {
  Obstacle floor = testing::ground();
  floor.geometry = HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = -0.25};
  EXPECT_LT(largest_rise_of_steps(std::nullopt, {floor}), kLittle);
  EXPECT_LT(largest_rise_of_steps(StretchLimitSettings{.max_stretch = 0.1}, {floor}), kLittle);
}

}  // namespace
}  // namespace sprung
