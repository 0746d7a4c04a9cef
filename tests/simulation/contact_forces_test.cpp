// Laws of the forces of contact.
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <optional>

namespace sprung {
namespace {

using testing::ground;
using testing::kGravity;
using testing::mass;
using testing::momentum;
using testing::one_particle;
using testing::run;
using testing::sleeps;

constexpr double kStep = 1.0e-3;  // [s]

/// The error of the balance of momentum in `seconds`, relative to the weight.
double imbalance(Simulator& simulator, double seconds) {
  simulator.reset_forces();
  const Vector3 before = momentum(simulator);
  run(simulator, seconds);
  const Vector3 gained = (momentum(simulator) - before) / seconds;
  const Vector3 weight = mass(simulator) * simulator.settings().gravity;
  return (simulator.contact_forces().rowwise().sum() - (gained - weight)).norm() / weight.norm();
}

/// A cube of 0.5 kg with its lowest corners at `height` [m], which explicit Euler keeps together.
BodyShape cube(double height) {
  const SpringMaterial material{.value = 50.0, .damping = 0.2};
  BodyShape shape = make_solid({.size = {0.2, 0.2, 0.2}, .resolution = {4, 4, 4}}, {.structural = material, .shear = material});
  set_total_mass(shape, 0.5);
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Vector3(0.0, 0.1 + height, 0.0);
  place(shape, pose, Vector3::Zero());
  return shape;
}

SimulatorSettings settings_of(const IntegratorSettings& integrator) {
  return {.step = kStep, .integrator = integrator, .sleep = false, .record_contact_forces = true};
}

class ContactForcesOfScheme : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static IntegratorSettings integrator() { return all_integrators()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Integrators, ContactForcesOfScheme, ::testing::Range(std::size_t{0}, all_integrators().size()));

// A position of about 0.1 m is rounded by epsilon / 2 = 1e-17 in each of some ten projections of a step, a force by m 1e-16 / dt^2
// = 1e-10 m [N]. Implicit Euler solves its linear systems to 1e-8 of the load.
constexpr double kRounding = 1.0e-7;

// The momentum of a body without pins changes by its weight and by contact alone, in flight, impact, sliding and rest.
TEST_P(ContactForcesOfScheme, AreTheGainOfMomentumMinusTheWeight) {
  for (const std::optional<StretchLimitSettings>& limit :
       {std::optional<StretchLimitSettings>(), std::optional(StretchLimitSettings{.max_stretch = 0.05})}) {
    NetworkBuilder builder;
    builder.add_body("cube", cube(0.03), {.thickness = 0.005, .friction = 0.3, .static_friction = 0.3, .restitution = 0.2});
    SimulatorSettings settings = settings_of(integrator());
    settings.stretch_limit = limit;
    Simulator simulator(builder.build(), settings, {ground({}, 0.2)});
    run(simulator, 0.01);  // Verlet's velocity is first that of time 0, later that of half a step ago
    for (int interval = 0; interval < 4; ++interval) {
      EXPECT_LT(imbalance(simulator, 0.1), kRounding) << "interval " << interval << (limit ? ", limited" : "");
    }
    EXPECT_GT(simulator.contact_count(), 0);
  }
}

// Action and reaction: together, two bodies that collide without gravity give each other nothing.
TEST_P(ContactForcesOfScheme, OfTwoBodiesAreOpposite) {
  NetworkBuilder builder;
  builder.add_body("lower", cube(0.0), {.thickness = 0.005, .friction = 0.3, .static_friction = 0.3});
  BodyShape upper = cube(0.22);
  for (Vector3& velocity : upper.velocities) velocity.y() -= 0.5;
  builder.add_body("upper", upper, {.thickness = 0.005, .friction = 0.3, .static_friction = 0.3});
  SimulatorSettings settings = settings_of(integrator());
  settings.gravity.setZero();
  Simulator simulator(builder.build(), settings);
  run(simulator, 0.2);
  const Points forces = simulator.contact_forces();
  const Vector3 on_lower = forces.leftCols(64).rowwise().sum();
  const Vector3 on_upper = forces.rightCols(64).rowwise().sum();
  const Vector3 gained = simulator.state().v.leftCols(64) * simulator.network().masses.head(64) / 0.2;
  EXPECT_LT(on_lower.y(), -0.1);
  EXPECT_LT((on_lower + on_upper).norm(), kRounding * on_lower.norm());
  EXPECT_LT((on_lower - gained).norm(), kRounding * on_lower.norm());
}

// Pins and contact together give the gain of momentum minus the weight: a cloth between its pins sags on a ball.
TEST_P(ContactForcesOfScheme, AndThoseOfPinsAreTheGainOfMomentumMinusTheWeight) {
  NetworkBuilder builder;
  const SpringMaterial material{.value = 50.0, .damping = 0.2};
  BodyShape cloth = make_cloth({.size = {1.0, 1.0}, .resolution = {9, 9}}, {.structural = material, .shear = material});
  set_total_mass(cloth, 0.5);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  place(cloth, pose);
  builder.add_body("cloth", cloth, {.thickness = 0.01, .friction = 0.3});
  builder.add_pin({.particles = {0, 8, 41, 72, 80}, .name = "corners and one beside the middle"});
  SimulatorSettings settings = settings_of(integrator());
  settings.record_forces = true;
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.1}, .material = {.friction = 0.3}};
  ball.rest_pose.translation() = Vector3(0.0, -0.11, 0.0);
  Simulator simulator(builder.build(), settings, {ball});
  run(simulator, 0.01);
  for (int interval = 0; interval < 3; ++interval) {
    simulator.reset_forces();
    const Vector3 before = momentum(simulator);
    run(simulator, 0.1);
    const Vector3 weight = mass(simulator) * simulator.settings().gravity;
    const Vector3 outside = (momentum(simulator) - before) / 0.1 - weight;
    const Vector3 given = simulator.reactions().at(0).force + simulator.contact_forces().rowwise().sum();
    EXPECT_LT((given - outside).norm(), kRounding * weight.norm()) << interval;
  }
  EXPECT_GT(simulator.contact_count(), 0);
}

// Coulomb: R = m g cos a along the normal, and friction of mu R against the motion.
TEST_P(ContactForcesOfScheme, OfASlidingParticleAreItsLoadAndItsFriction) {
  constexpr double kAngle = 0.5;
  constexpr double kFriction = 0.2;
  Simulator simulator(one_particle({0.0, 1.0e-4, 0.0}, {.friction = kFriction, .static_friction = kFriction}),
                      settings_of(integrator()), {ground({.friction = kFriction, .static_friction = kFriction}, kAngle)});
  run(simulator, 0.1);
  simulator.reset_forces();
  run(simulator, 0.1);
  const Vector3 normal(-std::sin(kAngle), std::cos(kAngle), 0.0);
  const Vector3 along(std::cos(kAngle), std::sin(kAngle), 0.0);
  const double load = 0.1 * kGravity * std::cos(kAngle);
  const Vector3 force = simulator.contact_forces().col(0);
  // Contact ends within kTouch = 1e-9 of its gap of 1 mm: 1e-12 m / dt^2, a ten-millionth of g.
  EXPECT_NEAR(force.dot(normal), load, 1.0e-6 * load);
  EXPECT_NEAR(force.dot(along), kFriction * load, 1.0e-6 * load);
}

TEST_P(ContactForcesOfScheme, AreRecordedWithoutAChangeOfAnyBit) {
  NetworkBuilder builder;
  builder.add_body("cube", cube(0.01), {.thickness = 0.005, .friction = 0.3});
  SimulatorSettings settings = settings_of(integrator());
  Simulator recording(builder.build(), settings, {ground()});
  settings.record_contact_forces = false;
  Simulator plain(builder.build(), settings, {ground()});
  for (Simulator* simulator : {&recording, &plain}) run(*simulator, 0.2);
  EXPECT_EQ(recording.positions(), plain.positions());
  EXPECT_EQ(recording.state().v, plain.state().v);
  EXPECT_EQ(plain.contact_forces(), Points::Zero(3, 64));
}

// A penalty carries the weight too. Its force at the end of a step stands for that within, so an interval of rest is compared.
TEST_P(ContactForcesOfScheme, OfAPenaltyCarryTheWeight) {
  SimulatorSettings settings = settings_of(integrator());
  settings.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1000.0, .damping = 5.0};
  Simulator simulator(one_particle({0.0, 0.01, 0.0}, {.thickness = 0.005}), settings, {ground()});
  run(simulator, 2.0);
  simulator.reset_forces();
  run(simulator, 0.1);
  // The oscillation has lost its energy at the rate of 5 N s/m / 0.1 kg = 50 /s for 2 s.
  EXPECT_NEAR(simulator.contact_forces()(1, 0), 0.1 * kGravity, 1.0e-6);
}

TEST(ContactForces, StayWhileABodySleeps) {
  NetworkBuilder builder;
  builder.add_body("cube", cube(0.005), {.thickness = 0.005});
  SimulatorSettings settings = settings_of(VerletSettings{.damping = 0.02});
  settings.sleep = true;
  Simulator simulator(builder.build(), settings, {ground()});
  for (int k = 0; k < 20000 && !sleeps(simulator); ++k) simulator.step();
  ASSERT_TRUE(sleeps(simulator));
  simulator.reset_forces();
  run(simulator, 0.1);
  const double weight = mass(simulator) * kGravity;
  // It falls asleep while it still moves: by less than a gap of 5 mm in a window of 0.25 s or more, so its momentum changes by less
  // than m 0.02 m/s / 0.25 s, a hundredth of its weight.
  EXPECT_NEAR(simulator.contact_forces().row(1).sum(), weight, 0.01 * weight);
}

}  // namespace
}  // namespace sprung
