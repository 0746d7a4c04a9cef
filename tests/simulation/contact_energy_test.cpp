// Contact adds no energy, at any step.
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

/// A tilted cloth of 1 m and n x n particles a little above a ball, which an edge and a corner touch at once.
SpringNetwork tilted_cloth(Index n) {
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

/// The largest increase [J] of the kinetic, gravity and elastic energy over its initial value.
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

/// The energy [J] by which speeds lag behind by half a step.
double lag(double step) { return kMass * kGravity * std::sqrt(2.0 * kGravity * kHeight) * step / 2.0; }

/// The energy [J] that contact adds when it pushes a particle with eight springs out of the gap. Truncation allows a depth of at
/// most half of the gap.
double push_energy(double particles) {
  const double deep = 0.5 * kThickness;
  return kMass / particles * kGravity * deep + 8.0 * 0.5 * kStiffness * deep * deep;
}

TEST(ContactEnergy, ContactGainsNoEnergyInSmallSteps) {
  const SpringNetwork network = tilted_cloth(3);
  for (const int steps_a_frame : {5, 1000, 6000}) {
    const double step = 1.0 / (60.0 * steps_a_frame);
    EXPECT_LT(most_gained(network, {.step = step, .integrator = VerletSettings{}}), push_energy(9.0) + lag(step)) << steps_a_frame;
  }
}

// A push out of the gap also moves neighbours whose springs are at their limit, and they keep that velocity. The velocity must not
// be a gap per step, however short the step is.
TEST(ContactEnergy, ContactAndAStretchLimitGainNoEnergyInSmallSteps) {
  const SpringNetwork network = tilted_cloth(7);
  for (const int steps_a_frame : {10, 200, 1000}) {
    const double step = 1.0 / (60.0 * steps_a_frame);
    const SimulatorSettings settings{
        .step = step, .integrator = SymplecticEulerSettings{}, .stretch_limit = StretchLimitSettings{.max_stretch = 0.005}};
    EXPECT_LT(most_gained(network, settings), push_energy(49.0) + lag(step)) << steps_a_frame;
  }
}

/// A nearly upright rope of 1 m and 31 particles on the ground, with self-contact.
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

// The rope folds in its plane, segment onto segment. After 2 s it lies on the ground, and no particle is lifted by a gap any more.
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

/// A limp cloth of 1 m and 1 kg with self-contact that flies down at `speed` [m/s], tilted.
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

// A surface of speed u hits the cloth at speed v. Without restitution the cloth leaves it at v + u at most. Elements that
// self-contact blocks move with the drum's surface. If distant ends received the velocity of a rigid rotation at their radius, the
// energy would be 5,000 J instead of 50 J.
TEST(ContactEnergy, ASpinningDrumThrowsNothingFasterThanItsRim) {
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
