// Contact takes energy or leaves it, in steps of any size.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sprung {
namespace {

using testing::kGravity;

constexpr double kMass = 0.2;
constexpr double kStiffness = 100.0;
constexpr double kThickness = 0.01;
constexpr double kHeight = 0.25;

/// A cloth of 1 m and n x n particles, askew, a little above a ball, which an edge and a corner of it meet at once.
SpringNetwork cloth_askew(Index n) {
  const SpringMaterial spring{.value = kStiffness};
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {n, n}}, {.structural = spring, .shear = spring, .bend = spring});
  set_total_mass(shape, kMass);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-80.0, 10.0, 0.0});
  pose.translation() = Vector3(0.0, kHeight, 0.0);
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = kThickness});
  return builder.build();
}

/// The most that motion, height and springs ever have beyond what they began with [J].
double most_gained(const SpringNetwork& network, const SimulatorSettings& settings) {
  Simulator simulator(network, settings, {{.name = "ball", .geometry = SphereGeometry{.radius = 0.2}}});
  const auto energy = [&] {
    const double motion = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
    return motion + simulator.elastic_energy() + simulator.gravity_energy();
  };
  const double begin = energy();
  double most = 0.0;
  for (double time = 0.0; time < 0.35; time += settings.step) {
    simulator.step();
    most = std::max(most, energy() - begin);
  }
  return most;
}

/// Speeds lag behind by half a step [J].
double lag(double step) { return kMass * kGravity * std::sqrt(2.0 * kGravity * kHeight) * step / 2.0; }

/// What contact pushes out of the gap is then higher, and springs are longer, by half of the gap at most, which is what truncation
/// leaves of it: of a particle with eight springs [J].
double pushed(double particles) {
  const double deep = 0.5 * kThickness;
  return kMass / particles * kGravity * deep + 8.0 * 0.5 * kStiffness * deep * deep;
}

TEST(ContactEnergy, ContactMakesNoneInSmallSteps) {
  const SpringNetwork network = cloth_askew(3);
  for (const int parts : {5, 1000, 6000}) {
    const double step = 1.0 / (60.0 * parts);
    EXPECT_LT(most_gained(network, {.step = step, .integrator = VerletSettings{}}), pushed(9.0) + lag(step)) << parts;
  }
}

// What a push out of the gap draws after it by links at their limit keeps the push's speed: it must not be a gap in a step, however
// short.
TEST(ContactEnergy, ContactAndAStretchLimitMakeNoneInSmallSteps) {
  const SpringNetwork network = cloth_askew(7);
  for (const int parts : {10, 200, 1000}) {
    const double step = 1.0 / (60.0 * parts);
    const SimulatorSettings settings{
        .step = step, .integrator = SymplecticEulerSettings{}, .stretch_limit = StretchLimitSettings{.max_stretch = 0.005}};
    EXPECT_LT(most_gained(network, settings), pushed(49.0) + lag(step)) << parts;
  }
}

/// A rope of 1 m and 31 particles, all but upright on the ground, that meets itself.
SpringNetwork upright_rope() {
  RopeShape rope;
  rope.points = {Vector3(0.0, 0.1, 0.0), Vector3(0.03, 1.1, 0.0)};
  rope.particles = 31;
  BodyShape shape = make_rope(rope, {.structural = SpringMaterial{.value = 500.0, .damping = 0.05}});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape, {.thickness = kThickness, .friction = 0.4, .static_friction = 0.4}, {.self = true});
  return builder.build();
}

// It folds in its plane, segments back onto those before. After 2 s it lies, and no particle is lifted by a gap any more.
TEST(ContactEnergy, ARopeThatFoldsInAPlaneComesToRest) {
  const SpringNetwork network = upright_rope();
  Simulator simulator(network, {.step = 1.0 / 480.0, .integrator = VerletSettings{.damping_rate = 0.5}},
                      {testing::ground({.friction = 0.4, .static_friction = 0.4})});
  testing::run(simulator, 2.0);
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 6 * 480; ++step) {
    simulator.step();
    const double motion = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
    const double energy = motion + simulator.elastic_energy() + simulator.gravity_energy();
    least = std::min(least, energy);
    ASSERT_LT(energy - least, network.masses[0] * kGravity * kThickness) << "step " << step;
  }
  EXPECT_GT(simulator.contact_count(), 0);
}

/// A limp cloth of 1 m and 1 kg that flies down at `speed` [m/s], askew, and may not pass through itself.
SpringNetwork flying_cloth(double speed) {
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {10, 10}}, {.structural = SpringMaterial{.value = 20.0}});
  set_total_mass(shape, 1.0);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({90.0, 48.0, -5.0});
  pose.translation() = Vector3(0.0, 0.8, 0.03);
  place(shape, pose, {0.0, -speed, 0.0});
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = 0.02}, {.self = true});
  return builder.build();
}

// What a surface of speed u hits at v leaves it, without restitution, no faster than at v + u. What is in the way of itself goes
// along with what pinches it, far ends too, which got the speed that what spins would have out there: 5,000 J of 50.
TEST(ContactEnergy, WhatSpinsThrowsNothingFasterThanItsRim) {
  constexpr double kFlight = 10.0;  // [m/s]
  constexpr double kSpin = 3000.0;  // [degrees/s]
  const double rim = std::hypot(0.2, 0.1) * kSpin * std::numbers::pi / 180.0;
  Obstacle drum{.name = "drum", .geometry = CylinderGeometry{.radius = 0.2, .height = 0.2}, .material = {.thickness = 0.02}};
  drum.motion.spin = Vector3(0.0, 0.0, kSpin);
  const SpringNetwork network = flying_cloth(kFlight);
  Simulator simulator(network, {.step = 1.0 / 200.0, .gravity = Vector3::Zero()}, {drum});
  for (int step = 0; step < 100; ++step) {
    simulator.step();
    const double energy = 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
    ASSERT_LT(energy, 0.5 * 1.0 * (kFlight + rim) * (kFlight + rim)) << "step " << step;
  }
}

}  // namespace
}  // namespace sprung
