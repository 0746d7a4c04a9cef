// Laws of changes to a simulation under way.
#include "base/error.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/forces/pull_force.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace sprung {
namespace {

using testing::cloth;
using testing::ground;
using ::testing::HasSubstr;
using testing::kGravity;
using testing::one_particle;
using testing::run;
using testing::sheet;

constexpr double kStep = 1.0e-3;  // [s]

SpringNetwork hanging_mass(double stiffness, double damping) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, stiffness, 1.0, damping);
  builder.pin(hook);
  return builder.build();
}

SpringNetwork moving_cloth() {
  SpringNetwork network = cloth(8, 1.0);
  network.velocities = 0.1 * Points::Random(3, network.particle_count());
  return network;
}

TEST(SimulatorChanges, AChangeToTheSameModelChangesNoBit) {
  std::vector<std::optional<StretchLimitSettings>> limits(2);
  limits[1].emplace();
  for (const IntegratorSettings& integrator : all_integrators()) {
    for (const auto& limit : limits) {
      // Small enough for explicit Euler, which gains energy at any step.
      const SimulatorSettings settings{.step = 1.0e-5, .integrator = integrator, .stretch_limit = limit, .max_substeps = 4};
      Simulator whole(moving_cloth(), settings);
      Simulator changed(whole.network(), settings);
      run(whole, 0.002);
      run(changed, 0.001);
      changed.continue_with(changed.network(), changed.settings());
      run(changed, 0.001);
      EXPECT_EQ(changed.positions(), whole.positions()) << integrator.index();
      EXPECT_EQ(changed.state().v, whole.state().v) << integrator.index();
      EXPECT_EQ(changed.time(), whole.time());
    }
  }
}

// Without forces Verlet moves a particle by the same displacement in each step, up to the rounding of n sums.
TEST(SimulatorChanges, AParticleMovesUniformlyOnceGravityIsOff) {
  Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = kStep});
  run(simulator, 0.5);
  simulator.set_gravity(Vector3::Zero());
  const Vector3 start = simulator.positions();
  const Vector3 velocity = simulator.state().v;
  EXPECT_LT(velocity.y(), -4.9);
  run(simulator, 0.5);
  const double rounding = 500.0 * 500.0 * std::numeric_limits<double>::epsilon() * start.norm();
  EXPECT_LE((simulator.positions() - start - 0.5 * velocity).norm(), rounding);
}

// A damped bob comes to rest where the spring balances its weight: at m g / k.
TEST(SimulatorChanges, ASpringBalancesTheWeightByItsNewStiffness) {
  Simulator simulator(hanging_mass(100.0, 20.0), {.step = kStep});
  run(simulator, 5.0);
  EXPECT_NEAR(simulator.positions()(1, 1), -1.0 - kGravity / 100.0, 1e-9);
  simulator.set_springs(0, SpringKind::structural, 400.0, 40.0);
  run(simulator, 5.0);
  EXPECT_NEAR(simulator.positions()(1, 1), -1.0 - kGravity / 400.0, 1e-9);
}

TEST(SimulatorChanges, WindMovesAParticleAtItsOwnSpeed) {
  Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = kStep, .gravity = Vector3::Zero()});
  run(simulator, 0.1);
  EXPECT_EQ(Vector3(simulator.positions()), Vector3::Zero());
  simulator.set_air(10.0, Vector3(3.0, 0.0, 0.0));
  run(simulator, 1.0);  // 100 times the time constant m / c
  EXPECT_NEAR(simulator.state().v(0, 0), 3.0, 1e-9);
}

TEST(SimulatorChanges, AStretchLimitHoldsFromTheStepAfterItIsSet) {
  Simulator simulator(hanging_mass(20.0, 5.0), {.step = kStep});
  run(simulator, 0.1);  // it falls by less than g t^2 / 2 = 0.05 m
  simulator.set_stretch_limit(StretchLimitSettings{.max_stretch = 0.1});
  run(simulator, 1.0);
  EXPECT_GT(simulator.positions()(1, 1), -1.1 * (1.0 + StretchLimitSettings{}.tolerance) - 1e-9);
  simulator.set_stretch_limit(std::nullopt);
  run(simulator, 6.0);  // the swing of 0.4 m fades by exp(-c t / 2 m) = exp(-15)
  EXPECT_NEAR(simulator.positions()(1, 1), -1.0 - kGravity / 20.0, 1e-6);
}

// The bob rests 0.49 m below its rest length. In one step the way to the limit is a speed of 390 m/s.
TEST(SimulatorChanges, ATighterStretchLimitMovesParticlesWithoutGivingThemVelocity) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(hanging_mass(20.0, 5.0), {.step = kStep, .integrator = integrator});
    run(simulator, 6.0);
    simulator.set_stretch_limit(StretchLimitSettings{.max_stretch = 0.1});
    for (int step = 0; step < 100; ++step) {
      simulator.step();
      EXPECT_LT(simulator.state().v.col(1).norm(), 2.0 * kGravity * kStep) << integrator.index();
      EXPECT_GT(simulator.positions()(1, 1), -1.1 * (1.0 + 2.0 * StretchLimitSettings{}.tolerance)) << integrator.index();
    }
  }
}

// The next step removes with speed what excess remains: at most 1e-6 m in each of the five springs, so 5 mm/s.
TEST(SimulatorChanges, ATighterStretchLimitMovesAChainWithoutGivingItVelocity) {
  NetworkBuilder builder;
  constexpr Index kParticles = 6;
  for (Index i = 0; i < kParticles; ++i) builder.add_particle({0.0, -1.2 * i, 0.0}, 1.0);
  for (Index i = 1; i < kParticles; ++i) builder.add_spring(i - 1, i, 0.0, 1.0, 0.0);
  builder.pin(0);
  for (const auto solver : {StretchLimitSettings::Solver::gauss_seidel, StretchLimitSettings::Solver::newton}) {
    Simulator simulator(builder.build(), {.step = kStep, .gravity = Vector3::Zero()});
    simulator.set_stretch_limit(StretchLimitSettings{.max_stretch = 0.1, .tolerance = 0.01, .solver = solver});
    for (int step = 0; step < 10; ++step) {
      simulator.step();
      EXPECT_LT(simulator.state().v.colwise().norm().maxCoeff(), 1.0e-2) << step;
    }
    EXPECT_LT(simulator.positions().row(1).minCoeff(), -5.0) << "it does not shrink";
  }
}

// The pin is on the other side of the sheet: the limit pulls the bob to it.
TEST(SimulatorChanges, ATighterStretchLimitMovesParticlesThroughNoObstacle) {
  NetworkBuilder builder;
  builder.begin_body("pair", {.thickness = 0.01});
  const Index hook = builder.add_particle({0.0, -1.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.1, 0.5, 0.2}, 1.0);
  builder.add_spring(hook, bob, 0.0, 0.5);
  builder.pin(hook);
  Simulator simulator(builder.build(), {.step = kStep}, {sheet(2.0, {.thickness = 0.01})});
  simulator.step();
  simulator.set_stretch_limit(StretchLimitSettings{.max_stretch = 0.1});
  EXPECT_GT(simulator.positions()(1, bob), 0.0);
  EXPECT_LT(simulator.positions()(1, bob), 0.1) << "it stops at the sheet";
  run(simulator, 0.1);
  EXPECT_GT(simulator.positions()(1, bob), 0.0);
}

TEST(SimulatorChanges, APinnedParticleStaysAndAReleasedOneFallsFromRest) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = kStep, .integrator = integrator});
    run(simulator, 0.2);
    simulator.pin(0);
    const Vector3 held = simulator.positions();
    run(simulator, 0.2);
    EXPECT_EQ(Vector3(simulator.positions()), held) << integrator.index();
    EXPECT_EQ(Vector3(simulator.state().v), Vector3::Zero()) << integrator.index();
    simulator.release(0);
    run(simulator, 0.2);
    // The schemes' sums differ from g t^2 / 2 by at most a step at the final speed.
    EXPECT_NEAR(simulator.positions()(1, 0), held.y() - 0.5 * kGravity * 0.04, kGravity * 0.2 * kStep) << integrator.index();
  }
}

// A block on a slope of 20 degrees stays if tan 20 = 0.36 is below its friction, and slides otherwise.
TEST(SimulatorChanges, FrictionChangesUnderABody) {
  const ContactMaterial rough{.thickness = 0.01, .friction = 0.6, .static_friction = 0.6};
  const ContactMaterial smooth{.thickness = 0.01};
  const double angle = 20.0 * std::numbers::pi / 180.0;
  const Vector3 normal(-std::sin(angle), std::cos(angle), 0.0);
  Simulator simulator(one_particle(0.02 * normal, rough), {.step = kStep}, {ground(rough, angle)});
  run(simulator, 0.5);
  EXPECT_LT((Vector3(simulator.positions()) - 0.02 * normal).norm(), 1e-3);
  simulator.set_body_material(0, smooth);
  run(simulator, 0.5);
  EXPECT_LT(simulator.positions()(0, 0), -0.2);
  simulator.set_body_material(0, rough);
  simulator.set_obstacle_material(0, smooth);
  const double before = simulator.positions()(0, 0);
  run(simulator, 0.1);
  EXPECT_LT(simulator.positions()(0, 0), before - 0.1);
  simulator.set_obstacle_material(0, rough);
  run(simulator, 2.0);
  const Vector3 stopped = simulator.positions();
  run(simulator, 0.1);
  EXPECT_LT((Vector3(simulator.positions()) - stopped).norm(), 1e-6);
}

template <class Change>
void expect_refused(const std::string& key, const Change& change) {
  Simulator simulator(moving_cloth(), {.step = kStep}, {ground({.thickness = 0.01})});
  Simulator untouched(simulator.network(), simulator.settings(), simulator.obstacles());
  run(simulator, 0.02);
  run(untouched, 0.02);
  try {
    change(simulator);
    FAIL() << key;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(key));
  }
  run(simulator, 0.02);
  run(untouched, 0.02);
  EXPECT_EQ(simulator.positions(), untouched.positions()) << key;
}

// Verlet's positions lie on the parabola of free flight at any step. A pin that began before the change turns a quarter a second
// about the origin, from where it took its particle.
TEST(SimulatorChanges, TheStepChangesAtTheEndOfAFrame) {
  NetworkBuilder builder;
  const Vector3 velocity(1.0, 2.0, 0.0);
  const Index ball = builder.add_particle(Vector3::Zero(), 0.1, velocity);
  const Index turned = builder.add_particle(Vector3::UnitX(), 0.1);
  Pin pin;
  pin.particles = {turned};
  pin.from = 0.054;  // not at a step
  pin.motion.spin = Vector3(0.0, 0.0, 90.0);
  builder.add_pin(pin);
  constexpr double kFrame = 0.04;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  SimulatorSettings settings{.step = kFrame / 4, .steps_per_frame = 4, .gravity = {0.0, -kGravity, 0.0}};
  Simulator simulator(builder.build(), settings);
  const auto change_steps = [&](int steps) {
    settings.step = kFrame / steps;
    settings.steps_per_frame = steps;
    simulator.continue_with(simulator.network(), settings);
  };
  for (int step = 0; step < 8; ++step) simulator.step();
  const Vector3 start =
      simulator.positions().col(turned);  // the pin began at 0.05 s, the nearest step, to where the particle had fallen
  ASSERT_EQ(simulator.state().frame, 2);
  change_steps(7);
  for (int step = 0; step < 7; ++step) simulator.step();
  EXPECT_EQ(simulator.state().frame, 3);
  EXPECT_EQ(simulator.state().step_in_frame, 0);
  EXPECT_NEAR(simulator.time(), 3 * kFrame, kEpsilon);
  ASSERT_EQ(simulator.state().grips.size(), 1U);
  EXPECT_EQ(simulator.state().grips[0].time, 0.05) << "the pin has not begun anew";
  change_steps(2);
  for (int step = 0; step < 3; ++step) simulator.step();
  EXPECT_EQ(simulator.state().frame, 4);
  EXPECT_EQ(simulator.state().step_in_frame, 1);
  EXPECT_EQ(simulator.state().step, 18);
  const double t = 4.5 * kFrame;
  EXPECT_NEAR(simulator.time(), t, kEpsilon);
  const Vector3 gravity(0.0, -kGravity, 0.0);
  // 18 steps with a few roundings each of differences that later steps add up. Positions are below 1 m.
  EXPECT_LT((simulator.positions().col(ball) - (t * velocity + 0.5 * t * t * gravity)).norm(), 18 * 18 * kEpsilon);
  const RigidTransform turn = pin.motion.pose(RigidTransform::Identity(), t - 2 * kFrame);
  EXPECT_LT((simulator.positions().col(turned) - turn * start).norm(), 8 * kEpsilon) << "two poses and a product";
}

TEST(SimulatorChanges, TheStepChangesNeitherWithinAFrameNorTheFrame) {
  SimulatorSettings settings{.step = 0.01, .steps_per_frame = 4};
  Simulator simulator(one_particle(Vector3::Zero()), settings);
  simulator.step();
  const auto refusal = [&](double step, int steps_per_frame) -> std::string {
    settings.step = step;
    settings.steps_per_frame = steps_per_frame;
    try {
      simulator.continue_with(simulator.network(), settings);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(0.02, 2), HasSubstr("may change at the end of a frame alone"));
  EXPECT_THAT(refusal(0.02, 4), HasSubstr("must stay a frame of 0.04 s"));
  EXPECT_THAT(refusal(0.01, 5), HasSubstr("must stay a frame of 0.04 s"));
  for (int step = 0; step < 3; ++step) simulator.step();
  EXPECT_EQ(refusal(0.02, 2), "");
}

TEST(SimulatorChanges, ACopyHasNothingThatStopsIt) {
  Simulator simulator(one_particle(Vector3::Zero()), {.step = kStep});
  simulator.stop_when([] { return true; });
  Simulator copy = simulator;
  copy.step();
  EXPECT_THROW(simulator.step(), StoppedError);
}

TEST(SimulatorChanges, ARefusedChangeChangesNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("step", [](Simulator& simulator) {
    SimulatorSettings settings = simulator.settings();
    settings.step *= 0.5;
    simulator.continue_with(simulator.network(), settings);
  });
  expect_refused("bodies", [](Simulator& simulator) { simulator.continue_with(cloth(4, 1.0), simulator.settings()); });
  expect_refused("contact", [](Simulator& simulator) {
    SpringNetwork network = simulator.network();
    network.bodies[0].contact.self = true;
    simulator.continue_with(std::move(network), simulator.settings());
  });
  expect_refused("step", [](Simulator& simulator) { simulator.set_springs(0, SpringKind::structural, 1e9, 0.0); });
  expect_refused("springs.shear.damping", [](Simulator& simulator) { simulator.set_springs(0, SpringKind::shear, 1.0, -1.0); });
  const auto with_attachment = [](const Attachment& attachment) {
    return [attachment](Simulator& simulator) {
      SpringNetwork network = simulator.network();
      network.attachments.push_back(attachment);
      simulator.continue_with(std::move(network), simulator.settings());
    };
  };
  expect_refused("attachments[0].first", with_attachment({.particles = {64}, .second = ObstacleEnd{0}}));
  expect_refused("attachments[0].second", with_attachment({.particles = {0}, .second = ParticleEnds{{-1}}}));
  expect_refused("attachments[0].second.body", with_attachment({.particles = {0}, .second = SurfaceEnd{1}}));
  expect_refused("pins[0]", [](Simulator& simulator) {
    SpringNetwork network = simulator.network();
    network.pins.emplace_back().particles = {64};
    simulator.continue_with(std::move(network), simulator.settings());
  });
  expect_refused("kinds of springs", [](Simulator& simulator) { simulator.set_springs(0, static_cast<SpringKind>(9), 1.0, 0.0); });
  expect_refused("gravity", [&](Simulator& simulator) { simulator.set_gravity({0.0, kNan, 0.0}); });
  expect_refused("friction", [](Simulator& simulator) { simulator.set_body_material(0, {.friction = -1.0}); });
  expect_refused("friction", [&](Simulator& simulator) { simulator.set_obstacle_material(0, {.friction = kNan}); });
}

/// The same force on every particle [N].
class EvenForce final : public Force {
 public:
  explicit EvenForce(const Vector3& force) : force_(force) {}
  void add(const Kinematics&, Points& forces) const override { forces.colwise() += force_; }

 private:
  Vector3 force_;
};

TEST(SimulatorChanges, AnExternalForceActsUntilItIsRemoved) {
  Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = kStep});
  const auto lift = std::make_shared<EvenForce>(Vector3(0.0, 0.1 * kGravity, 0.0));
  simulator.add_force(lift);
  run(simulator, 0.5);
  // The particle starts as Verlet's start has it, by g dt^2 / 2, before the force is there.
  EXPECT_NEAR(simulator.positions()(1, 0), 0.0, kGravity * kStep * 0.5);
  simulator.remove_force(*lift);
  const double height = simulator.positions()(1, 0);
  run(simulator, 0.5);
  EXPECT_NEAR(simulator.positions()(1, 0), height - 0.5 * kGravity * 0.25, 3.0 * kGravity * kStep * 0.5);
}

// Verlet's positions before time 0 depend on the forces.
TEST(SimulatorChanges, AtTime0OneGravityIsAsGoodAsAnother) {
  const Vector3 upwards(0.0, 3.0, 0.0);
  for (const IntegratorSettings& integrator : all_integrators()) {
    for (const bool adds_force : {true, false}) {
      Simulator built(one_particle({0.0, 1.0, 0.0}), {.step = kStep, .gravity = upwards, .integrator = integrator}, {ground()});
      Simulator changed(one_particle({0.0, 1.0, 0.0}), {.step = kStep, .integrator = integrator}, {ground()});
      changed.set_gravity(upwards);
      for (Simulator* simulator : {&built, &changed}) {
        if (adds_force) {
          simulator->add_force(std::make_shared<EvenForce>(Vector3::Zero()));
        } else {
          simulator->set_obstacle_material(0, {.thickness = 0.01});
        }
        run(*simulator, 0.01);
      }
      EXPECT_EQ(changed.positions(), built.positions()) << integrator.index() << ", " << adds_force;
    }
  }
}

TEST(SimulatorChanges, AFirstStepThatIsStoppedChangesNothing) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = kStep, .integrator = integrator});
    const SimulationState start = simulator.state();
    simulator.set_gravity({0.0, 3.0, 0.0});
    const SimulationState state = simulator.state();
    EXPECT_EQ(Simulator(simulator).state(), state);
    simulator.stop_when([] { return true; });
    EXPECT_THROW(simulator.step(), StoppedError);
    EXPECT_EQ(simulator.state(), state);
    simulator.set_gravity({0.0, -kGravity, 0.0});
    EXPECT_EQ(simulator.state().x_previous, start.x_previous);
  }
}

/// Does nothing but throw where a test asks it to.
class Faulty final : public Force {
 public:
  void add(const Kinematics&, Points&) const override {}
  [[nodiscard]] bool is_constant() const override { return true; }
  [[nodiscard]] std::optional<std::vector<Index>> touched() const override {
    if (throws_touched) throw std::runtime_error("touched");
    return std::vector<Index>{};
  }
  [[nodiscard]] double energy(const Points&) const override {
    if (throws_energy) throw std::runtime_error("energy");
    return 0.0;
  }

  bool throws_touched = false;
  bool throws_energy = false;
};

TEST(SimulatorChanges, AForceThatThrowsAsItIsAddedIsNotAdded) {
  for (const bool throws_energy : {true, false}) {
    Simulator simulator(moving_cloth(), {.step = kStep});
    run(simulator, 0.01);
    const SimulationState state = simulator.state();
    const auto faulty = std::make_shared<Faulty>();
    (throws_energy ? faulty->throws_energy : faulty->throws_touched) = true;
    EXPECT_THROW(simulator.add_force(faulty), std::runtime_error);
    EXPECT_EQ(simulator.state(), state);
    simulator.restore(state);
    simulator.step();
  }
}

TEST(SimulatorChanges, AForceThatThrowsInALaterChangeDoesNotStopTheRun) {
  Simulator simulator(moving_cloth(), {.step = kStep});
  const auto faulty = std::make_shared<Faulty>();
  simulator.add_force(faulty);
  run(simulator, 0.01);
  const SimulationState state = simulator.state();
  faulty->throws_energy = faulty->throws_touched = true;
  EXPECT_THROW(simulator.pin({3}, "finger"), std::runtime_error);
  EXPECT_EQ(simulator.state(), state);
  simulator.step();
  faulty->throws_energy = faulty->throws_touched = false;
  simulator.pin({3}, "finger");
  simulator.step();
  EXPECT_TRUE(simulator.network().is_pinned(3));
}

// Coordinates beyond 3.4e38 are infinite in single precision, squares beyond 1.8e308 in double precision. Contact may keep bodies
// from such speeds; else they diverge.
TEST(SimulatorChanges, AGravityBeyondTheRangeOfNumbersDivergesAtMost) {
  const auto rope = [](double x) {
    return make_rope({.points = {{x, 1.0, 0.0}, {x + 1.0, 1.0, 0.0}}, .particles = 4, .length = {}},
                     {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}, .shear = {}, .bend = {}});
  };
  BodyShape shape = make_cloth({.size = {0.5, 0.5}, .resolution = {3, 3}},
                               {.structural = SpringMaterial{.value = 200.0, .damping = 0.05}, .shear = {}, .bend = {}});
  RigidTransform above = RigidTransform::Identity();
  above.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  above.translation() = Vector3(0.0, 0.15, 0.0);
  place(shape, above, Vector3::Zero());
  NetworkBuilder builder;
  for (auto& [name, body] : {std::pair("cloth", shape), std::pair("held", rope(0.0)), std::pair("free", rope(1.5))}) {
    BodyShape with_mass = body;
    set_total_mass(with_mass, 0.1);
    builder.add_body(name, with_mass, {.thickness = 0.005});
  }
  builder.pin(9);
  Obstacle deforming = testing::deforming_sheet(Vector3(0.8, 1.0, 1.2).asDiagonal());
  deforming.rest_pose.translation() = Vector3(0.5, 0.8, 0.0);
  for (const double gravity : {1e20, 1e40, 1e50, 1e80, 1e120, 1e160, 1e300}) {
    Simulator simulator(builder.build(), {.step = kStep}, {ground({.thickness = 0.004}), deforming});
    simulator.step();
    simulator.set_gravity({0.0, -gravity, gravity});
    try {
      run(simulator, 10 * kStep);
    } catch (const StepError&) {
    }
    EXPECT_TRUE(simulator.positions().allFinite()) << gravity;
  }
}

/// Pulls particle 0 to the origin.
class Anchor final : public Force {
 public:
  explicit Anchor(double stiffness) : stiffness_(stiffness) {}
  [[nodiscard]] std::string name() const override { return "an anchor"; }
  void add(const Kinematics& at, Points& forces) const override { forces.col(0) -= stiffness_ * at.x.col(0); }
  void append_elements(std::vector<LinearElement>& elements) const override {
    elements.push_back(LinearElement::anchor(0, stiffness_, 0.0));
  }
  [[nodiscard]] double energy(const Points& positions) const override { return 0.5 * stiffness_ * positions.col(0).squaredNorm(); }

 private:
  double stiffness_;  ///< [N/m]
};

// The largest step of k / m = 1.0e8 / s^2 is 2.0e-4 s.
TEST(SimulatorChanges, AnExternalForceThatNeedsASmallerStepIsRefused) {
  Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = 1.0e-3});
  const double mass = simulator.network().masses[0];
  try {
    simulator.add_force(std::make_shared<Anchor>(1.0e8 * mass));
    FAIL() << "was added";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is beyond the largest stable step, 0.0002 s, bounded by an anchor"));
  }
  simulator.add_force(std::make_shared<Anchor>(100.0 * mass));
  EXPECT_DOUBLE_EQ(simulator.elastic_energy(), 50.0 * mass);
}

/// Has an element that a test chooses.
class OneElement final : public Force {
 public:
  explicit OneElement(const LinearElement& element) : element_(element) {}
  [[nodiscard]] std::string name() const override { return "one element"; }
  void add(const Kinematics&, Points&) const override {}
  void append_elements(std::vector<LinearElement>& elements) const override { elements.push_back(element_); }

 private:
  LinearElement element_;
};

TEST(SimulatorChanges, ElementsThatAreNotFiniteOrOnNoParticleAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const LinearElement& element : {LinearElement::anchor(0, kNan, 0.0), LinearElement::anchor(0, 1.0, kInfinity),
                                       LinearElement::anchor(1, 1.0, 0.0), LinearElement::anchor(-1, 1.0, 0.0)}) {
    Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = kStep});
    try {
      simulator.add_force(std::make_shared<OneElement>(element));
      ADD_FAILURE() << "was added";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("added force \"one element\".append_elements()[0]"));
    }
  }
}

/// Keeps particle 0 at a height [m].
class Shelf final : public Constraint {
 public:
  explicit Shelf(double height) : height_(height) {}
  double project(const Points& /*before*/, Points& positions, const ImpulseRecorder& /*recorder*/) const override {
    const double off = residual(positions);
    positions(1, 0) = height_;
    return off;
  }
  [[nodiscard]] double residual(const Points& positions) const override { return std::abs(positions(1, 0) - height_) / 1.0e-12; }

 private:
  double height_;
};

TEST(SimulatorChanges, AnAddedConstraintHoldsUntilItIsRemoved) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = kStep, .integrator = integrator});
    const auto shelf = std::make_shared<Shelf>(0.0);
    simulator.add_constraint(shelf);
    run(simulator, 0.5);
    EXPECT_EQ(simulator.positions()(1, 0), 0.0);
    simulator.remove_constraint(*shelf);
    run(simulator, 0.5);
    // At rest when it was let go, but for the first step's motion, which schemes define differently.
    EXPECT_NEAR(simulator.positions()(1, 0), -0.5 * kGravity * 0.25, 3.0 * kGravity * kStep * 0.5);
  }
}

// A free particle reaches the target and stays, at any step: it never moves past its target by more than it came.
TEST(PullForce, AParticleReachesItsTargetAtAnyStep) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    for (const double step : {1.0e-3, 0.02, 1.0}) {
      Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = step, .gravity = Vector3::Zero(), .integrator = integrator});
      const auto pull = std::make_shared<PullForce>(simulator.network(), simulator.positions(), 0, step);
      pull->set_target({1.0, 0.0, 0.0});
      simulator.add_force(pull);
      double farthest = 0.0;
      const int steps = std::max(200, static_cast<int>(2.0 / step));
      for (int k = 0; k < steps; ++k) {
        simulator.step();
        farthest = std::max(farthest, simulator.positions()(0, 0));
      }
      EXPECT_LE(farthest, 2.0) << integrator.index() << ", " << step;
      EXPECT_NEAR(simulator.positions()(0, 0), 1.0, 1e-3) << integrator.index() << ", " << step;
    }
  }
}

// The pull on a particle of a cloth lifts the cloth from the ground.
TEST(PullForce, ACornerLiftsItsCloth) {
  Simulator simulator(cloth(32, 0.02, {.thickness = 0.01}),
                      {.step = 5.0e-4, .stretch_limit = StretchLimitSettings{.max_stretch = 0.1}}, {ground({.thickness = 0.005})});
  const auto pull = std::make_shared<PullForce>(simulator.network(), simulator.positions(), 0, simulator.settings().step);
  simulator.add_force(pull);
  const Vector3 corner = simulator.positions().col(0);
  for (int k = 0; k < 4000; ++k) {
    pull->set_target(corner + std::min(1.0, k / 2000.0) * Vector3(0.0, 2.0, 0.0));
    simulator.step();
  }
  EXPECT_GT(simulator.positions().row(1).minCoeff(), 0.1);
}

}  // namespace
}  // namespace sprung
