// Laws of a whole step: pins, stability, divergence, determinism, stretch.
#include "base/error.h"
#include "base/parallel.h"
#include "collision/obstacles/obstacle_frame.h"
#include "simulation/diagnostics.h"
#include "simulation/scenes.h"
#include "simulation/step/step_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace sprung {
namespace {

using testing::cloth;
using ::testing::ElementsAre;
using testing::ground;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::one_particle;
using testing::rising_ball;
using testing::rod;
using testing::run;

SpringNetwork two_masses(double stiffness, double damping = 0.0) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, stiffness, 1.0, damping);
  builder.pin(hook);
  return builder.build();
}

/// By bits.
void expect_equal(const SimulationState& a, const SimulationState& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.x_previous, b.x_previous);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.substeps, b.substeps);
  EXPECT_EQ(a.substep, b.substep);
  EXPECT_EQ(a.grips.size(), b.grips.size());
  EXPECT_EQ(a.impulses.on_pinned, b.impulses.on_pinned);
  EXPECT_EQ(a.impulses.of_contact, b.impulses.of_contact);
}

TEST(Simulator, AFreeParticleFallsByTheSumOfItsScheme) {
  const double dt = 1e-2;
  const double n = 100.0;
  const std::vector<double> steps_of_gravity{n * (n - 1.0) / 2.0, n * (n + 1.0) / 2.0, n * n / 2.0,
                                             n * n / 2.0,         n * n / 2.0,         n * (n + 1.0) / 2.0};
  for (std::size_t i = 0; i < steps_of_gravity.size(); ++i) {
    Simulator simulator(one_particle({0.0, 0.0, 0.0}), {.step = dt, .integrator = all_integrators()[i]});
    run(simulator, n * dt);
    EXPECT_NEAR(simulator.positions()(1, 0), -testing::kGravity * dt * dt * steps_of_gravity[i], 1e-12) << i;
  }
}

// The pin turns by ten right angles in a step, so the step is divided into 20 substeps.
TEST(Simulator, StopsBetweenTheSubstepsOfAStep) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0, 0.5);
  builder.pin(hook, {.spin = {0.0, 900.0e3, 0.0}});
  Simulator simulator(builder.build(), {.step = 1e-3});
  int asked = 0;
  simulator.stop_when([&] { return ++asked == 30; });
  EXPECT_EQ(simulator.step().substeps, 20);
  const SimulationState begin = simulator.state();
  EXPECT_THROW(simulator.step(), StoppedError);
  EXPECT_EQ(asked, 30);
  expect_equal(simulator.state(), begin);
  simulator.stop_when({});
  run(simulator, 3e-3);
  Simulator whole(builder.build(), {.step = 1e-3});
  run(whole, 4e-3);
  expect_equal(simulator.state(), whole.state());
}

// The pin rotates by 45 degrees in the first step, and twice as far in the second.
TEST(FrameRunner, NamesTheReasonOfTheStepWithTheMostSubsteps) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({1.0, 0.0, 0.0}, 1.0);
  builder.add_particle({1.0, -1.0, 0.0}, 1.0);
  builder.pin(
      hook,
      {.keyframes = {{.time = 0.0}, {.time = 0.01, .rotation = {0.0, 45.0, 0.0}}, {.time = 0.02, .rotation = {0.0, 135.0, 0.0}}}});
  Simulator simulator(builder.build(), {.step = 0.01, .steps_per_frame = 3});
  FrameRunner frames(simulator);
  const FrameDiagnostics turning = frames.next_frame();
  EXPECT_EQ(turning.substeps, 1 + 2 + 1);
  EXPECT_EQ(turning.reason, PlanReason::rotation);
  const FrameDiagnostics still = frames.next_frame();
  EXPECT_EQ(still.substeps, 3);
  EXPECT_EQ(still.reason, PlanReason::first);
}

// A spring breaks and a pin begins before the step, which is stopped before its second substep.
TEST(Simulator, AStepThatIsStoppedChangesNothing) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1.3, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0, 0.5, SpringKind::structural, {.break_length = 1.2});
  builder.pin(hook, {.spin = {0.0, 900.0e3, 0.0}});
  const Index later = builder.add_particle({1.0, 0.0, 0.0}, 1.0);
  Pin pin;
  pin.particles = {later};
  pin.from = 0.0005;
  builder.add_pin(pin);
  Simulator simulator(builder.build(), {.step = 1e-3, .record_forces = true});
  const SimulationState begin = simulator.state();
  int asked = 0;
  simulator.stop_when([&] { return ++asked == 2; });
  EXPECT_THROW(simulator.step(), StoppedError);
  expect_equal(simulator.state(), begin);
  EXPECT_EQ(simulator.network().springs.count(), 1);
  EXPECT_FALSE(simulator.network().is_fixed(later));
  simulator.step();
  EXPECT_EQ(simulator.network().springs.count(), 0);
}

TEST(Simulator, AStepThatDivergesLeavesItsBegin) {
  Simulator simulator(two_masses(1e4), {.step = 0.03, .stability = StabilityCheck::warn});
  SimulationState begin = simulator.state();
  std::string cause;
  for (int step = 0; step < 100000 && cause.empty(); ++step) {
    begin = simulator.state();
    try {
      simulator.step();
    } catch (const StepError& error) {
      cause = error.what();
    }
  }
  ASSERT_FALSE(cause.empty());
  expect_equal(simulator.state(), begin);
  try {
    simulator.step();
    FAIL() << "the same step diverges again";
  } catch (const StepError& error) {
    EXPECT_EQ(error.what(), cause);
  }
}

TEST(Simulator, PinsFollowTheirKeyframesExactly) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({1.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({1.0, -1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0, 0.5);
  builder.pin(hook, {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, 2.0, 0.0}, .rotation = {0.0, 0.0, 90.0}}}});
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(builder.build(), {.step = 1e-3, .integrator = integrator});
    run(simulator, 0.5);
    // The pin has done half of its turn about the origin, from (1, 0) to (cos 45, sin 45), and half of its rise.
    const Vector3 expected(std::sqrt(0.5), std::sqrt(0.5) + 1.0, 0.0);
    EXPECT_LT((simulator.positions().col(hook) - expected).norm(), 1e-12);
    // The velocity is that of the next step, which the neighbours' dampers need. The difference quotient is off by dt/2 omega^2.
    const double omega = std::numbers::pi / 2.0;
    const Vector3 velocity = Vector3(-std::sqrt(0.5), std::sqrt(0.5), 0.0) * omega + Vector3(0.0, 2.0, 0.0);
    EXPECT_LT((simulator.state().v.col(hook) - velocity).norm(), 1e-3 * omega * omega);
  }
}

TEST(Simulator, AnUnstableStepIsRefusedAndTheLargestStableStepIsNamed) {
  // omega = sqrt(k / m) = 100 1/s. The largest step is 2 / omega = 0.02 s, less the margin of the estimate.
  try {
    Simulator simulator(two_masses(1e4), {.step = 0.021});
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].key, "step");
    EXPECT_THAT(error.what(), HasSubstr("0.021"));
    EXPECT_THAT(error.what(), HasSubstr("largest stable step, 0.0"));
    EXPECT_THAT(error.what(), HasSubstr("bounded by springs"));
  }
  EXPECT_NO_THROW(Simulator(two_masses(1e4), {.step = 0.018}));
}

// Dampers stop motion along the springs. Air drag also stops motion across them.
TEST(Simulator, ExplicitEulerCausesAWarningWhereItGainsEnergy) {
  const auto warnings = [](double stiffness, double damping) {
    return Simulator(two_masses(stiffness, damping), {.step = 1e-3, .integrator = ExplicitEulerSettings{}}).warnings();
  };
  EXPECT_THAT(warnings(100.0, 0.0), ElementsAre(HasSubstr("grows by a factor of e every 20 s")));
  EXPECT_THAT(warnings(100.0, 1.0), ElementsAre(HasSubstr("not perpendicular to taut springs")));
  EXPECT_THAT(warnings(0.0, 0.0), IsEmpty());

  RopeShape line;
  line.points = {Vector3::Zero(), Vector3::UnitX()};
  line.particles = 2;
  BodyShape rope = make_rope(line, {.structural = SpringMaterial{.value = 100.0, .damping = 1.0}});
  set_total_mass(rope, 2.0);
  NetworkBuilder builder;
  builder.add_body("rope", rope);
  EXPECT_THAT(Simulator(builder.build(), {.step = 1e-3, .air_drag = 1.0, .integrator = ExplicitEulerSettings{}}).warnings(),
              IsEmpty());
}

TEST(Simulator, ADivergingStepNamesParticleAndSpring) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1.1, 0.0}, 1.0);
  builder.add_spring(hook, bob, 1e4, 1.0);
  builder.pin(hook);
  Simulator simulator(builder.build(), {.step = 0.03, .stability = StabilityCheck::warn});
  ASSERT_EQ(simulator.warnings().size(), 1U);
  try {
    run(simulator, 1000.0);
    FAIL() << "did not diverge";
  } catch (const StepError& error) {
    EXPECT_EQ(error.failure().body, "network");
    EXPECT_EQ(error.failure().particle, 1);
    EXPECT_EQ(error.failure().spring, 0);
    EXPECT_GT(error.failure().step, 0);
    EXPECT_DOUBLE_EQ(error.failure().time, static_cast<double>(error.failure().step) * 0.03);
    EXPECT_THAT(error.what(), HasSubstr("use a step of at most 0.01"));
  }
}

// Two particles a micrometre apart, as in a sliver, part by 5 mm. The first bound is 1,000 times 1e-6 m, which 5 mm exceeds; the
// second is the other spring's length of 1 m.
TEST(Simulator, AShortSpringDivergesOnceItIsLongerThanTheLongestOfItsBody) {
  for (const bool has_long_spring : {false, true}) {
    NetworkBuilder builder;
    const Index left = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
    const Index right = builder.add_particle({1e-6, 0.0, 0.0}, 1.0, {0.005, 0.0, 0.0});
    builder.add_spring(left, right, 1e-6, 1e-6);
    if (has_long_spring) builder.add_spring(left, builder.add_particle({-1.0, 0.0, 0.0}, 1.0), 1e-6, 1.0);
    Simulator simulator(builder.build(), {.step = 0.01, .gravity = Vector3::Zero()});
    if (has_long_spring) {
      EXPECT_NO_THROW(run(simulator, 1.0));
    } else {
      EXPECT_THROW(run(simulator, 1.0), StepError);
    }
  }
}

// The springs have no stiffness, so a bob that no limit holds falls freely: Verlet is exact then.
TEST(Simulator, AStretchLimitHoldsItsBodiesAlone) {
  using Solver = StretchLimitSettings::Solver;
  BodyShape shape = make_rope({{Vector3::Zero(), -Vector3::UnitY()}, 2, std::nullopt}, {.structural = SpringMaterial{}});
  set_total_mass(shape, 2.0);
  for (const Solver solver : {Solver::gauss_seidel, Solver::newton, Solver::automatic}) {
    for (const bool tethers : {false, true}) {
      NetworkBuilder builder;
      for (const bool limited : {true, false}) {
        shape.stretch_limited = limited;
        builder.pin(builder.add_body(limited ? "limited" : "free", shape));
      }
      const StretchLimitSettings limit{.max_stretch = 0.1, .tethers = tethers, .solver = solver};
      Simulator simulator(builder.build(), {.step = 1e-3, .stretch_limit = limit});
      run(simulator, 0.5);
      EXPECT_GT(simulator.positions()(1, 1), -1.1 - limit.tolerance);
      EXPECT_NEAR(simulator.positions()(1, 3), -1.0 - testing::kGravity * 0.5 * 0.5 / 2.0, 1e-9);
    }
  }
}

TEST(Simulator, WarnsOfAStretchLimitOfKindsThatNoSpringHas) {
  const auto warnings = [](const SpringNetwork& network, std::vector<SpringKind> kinds) {
    return Simulator(network, {.stretch_limit = StretchLimitSettings{.kinds = std::move(kinds)}}).warnings();
  };
  const SpringNetwork rope = two_masses(100.0);
  EXPECT_THAT(warnings(rope, {SpringKind::shear, SpringKind::bend}),
              ElementsAre("stretch_limit.kinds = [\"shear\", \"bend\"] limits no spring: the network has only springs of "
                          "the kinds [\"structural\"]. Name kinds of these only."));
  EXPECT_THAT(warnings(rope, {SpringKind::shear, SpringKind::structural}),
              ElementsAre(HasSubstr("limits no spring of the kinds [\"shear\"]: the network has only")));
  EXPECT_THAT(warnings(rope, {SpringKind::structural}), IsEmpty());
  EXPECT_THAT(warnings(one_particle(Vector3::Zero()), {SpringKind::structural}), IsEmpty());
}

TEST(Simulator, WarnsOfWindWithoutDrag) {
  const auto warnings = [](double drag, const Vector3& wind) {
    return Simulator(two_masses(1.0), {.air_drag = drag, .wind = wind}).warnings();
  };
  EXPECT_THAT(warnings(0.0, Vector3::UnitX()), ElementsAre(HasSubstr("air.wind has no effect here")));
  EXPECT_THAT(warnings(0.1, Vector3::UnitX()), IsEmpty());
  EXPECT_THAT(warnings(0.0, Vector3::Zero()), IsEmpty());
}

/// A rope of three particles, 0.1 m apart, with springs of `stiffness` [N/m] and an angle bend of 1 N m.
SpringNetwork bent_rope(double stiffness) {
  NetworkBuilder builder;
  BodyShape shape = make_rope({.points = {{0.0, 0.0, 0.0}, {0.2, 0.0, 0.0}}, .particles = 3, .length = {}},
                              {.structural = SpringMaterial{.value = stiffness}, .shear = {}, .bend = {}});
  shape.angle_bends.append({0, 1, 2}, {0.1, 0.1}, 1.0, 0.0);
  set_total_mass(shape, 0.1);
  builder.add_body("rope", shape);
  return builder.build();
}

// pi k / d^2 = 314 N/m.
TEST(Simulator, WarnsOfAngleBendsOnWeakSprings) {
  const SimulatorSettings settings{.step = 1.0e-4};
  EXPECT_THAT(Simulator(bent_rope(320.0), settings).warnings(), IsEmpty());
  EXPECT_THAT(Simulator(bent_rope(310.0), settings).warnings(),
              ElementsAre(HasSubstr("a structural stiffness of at least 315 N/m")));
  SimulatorSettings limited = settings;
  limited.stretch_limit = StretchLimitSettings{.max_compression = 0.0};
  EXPECT_THAT(Simulator(bent_rope(0.0), limited).warnings(), IsEmpty());
}

// Explicit Euler multiplies the energy of a bob by 1 + (omega dt)^2 = 1.28 a step: 1/2 k 0.05^2 = 0.125 J become about 1e6 J in the
// 64 steps before energies are compared, 20,000 times the spring's capacity of 1/2 k 1^2. A bar breaks in almost each step; all
// bars together bring less than a millijoule.
TEST(Simulator, AnExplosionIsFoundWhileSpringsBreak) {
  constexpr double kStep = 0.0533;
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  builder.add_spring(hook, builder.add_particle({0.0, -1.05, 0.0}, 1.0), 100.0, 1.0);
  builder.pin(hook);
  for (int bar = 0; bar < 64; ++bar) {
    const double speed = 0.05 / (kStep * (bar + 0.5));  // longer by a tenth after half a step more than `bar` steps
    const Index left = builder.add_particle({10.0, 0.0, bar + 1.0}, 1.0e-6, {-speed, 0.0, 0.0});
    const Index right = builder.add_particle({11.0, 0.0, bar + 1.0}, 1.0e-6, {speed, 0.0, 0.0});
    builder.add_spring(left, right, 0.0, 1.0, 0.0, SpringKind::structural, {.break_length = 1.1});
  }
  Simulator simulator(builder.build(), {.step = kStep, .gravity = Vector3::Zero(), .integrator = ExplicitEulerSettings{}});
  try {
    run(simulator, 70.0 * kStep);
    FAIL() << "did not explode";
  } catch (const StepError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the energy exploded"));
    EXPECT_EQ(error.failure().step, 64);
  }
  EXPECT_GT(simulator.state().springs.broken_count(), 60);
}

TEST(Simulator, UnexplainedEnergyStopsTheRun) {
  // The bob swings by 5 cm and its amplitude grows without limit. The spring never reaches 1,000 times its length.
  SpringNetwork network = two_masses(100.0);
  network.positions(1, 1) = -1.05;
  SimulatorSettings settings{.step = 5e-3, .gravity = Vector3::Zero(), .integrator = ExplicitEulerSettings{}};
  Simulator simulator(network, settings);
  try {
    run(simulator, 1000.0);
    FAIL() << "did not explode";
  } catch (const StepError& error) {
    // Explicit Euler multiplies the energy by 1 + (omega dt)^2 per step. It starts at 1/2 k 0.05^2. The limit is 1,000 times the
    // sum of that and the spring's 1/2 k 1^2.
    const double growth = std::log1p(100.0 * 5e-3 * 5e-3);
    const double expected = std::log(1000.0 * (0.05 * 0.05 + 1.0) / (0.05 * 0.05)) / growth;
    // When the bob passes the hook, the spring pushes from the other side and the energy grows a little slower.
    EXPECT_NEAR(static_cast<double>(error.failure().step), expected, 0.1 * expected);
    EXPECT_THAT(error.what(), HasSubstr("the energy exploded"));
    EXPECT_EQ(error.failure().particle, 1);
    EXPECT_EQ(error.failure().spring, 0);
  }
}

TEST(Simulator, EnergyOfAPenaltyDoesNotStopTheRun) {
  SimulatorSettings settings{.step = 1.0 / 3000.0, .gravity = Vector3::Zero()};
  settings.contact = {.response = ContactSettings::Response::penalty, .stiffness = 10.0};
  Simulator simulator(one_particle({0.0, 0.005, 0.0}, {.thickness = 0.01}), settings, {ground()});
  EXPECT_NO_THROW(run(simulator, 0.5));
  // The penalty energy 1/2 k p^2 has become kinetic energy.
  EXPECT_NEAR(simulator.state().v(1, 0), std::sqrt(10.0 / simulator.network().masses[0]) * 0.005, 1.0e-3 * 0.05);
}

TEST(Simulator, EnergyOfGravityAndPinsDoesNotStopTheRun) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle(Vector3::Zero(), 1.0);
  const Index bob = builder.add_particle({0.0, -1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0, 1.0);
  // Smooth interpolation accelerates the pin from 0 to 1,000 m/s within 1 s.
  builder.pin(hook,
              {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {500.0, 0.0, 0.0}}}, .interpolation = Interpolation::smooth});
  Simulator driven(builder.build(), {.step = 1e-3});
  EXPECT_NO_THROW(run(driven, 1.5));
  Simulator falling(one_particle(Vector3::Zero()), {.step = 1e-2});
  EXPECT_NO_THROW(run(falling, 100.0));
}

TEST(Simulator, ExplicitEulerOnUndampedSpringsCausesAWarning) {
  const Simulator simulator(two_masses(100.0), {.step = 1e-3, .integrator = ExplicitEulerSettings{}});
  ASSERT_EQ(simulator.warnings().size(), 1U);
  EXPECT_THAT(simulator.warnings()[0], HasSubstr("symplectic_euler"));
}

TEST(Simulator, PenaltyStiffnessReducesTheStableStep) {
  // k / m = 1e6 / 0.1, omega = 3162 1/s. The largest step is 0.63 ms.
  SimulatorSettings settings{.step = 1e-3};
  settings.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1e6};
  EXPECT_THROW(Simulator(one_particle({0.0, 1.0, 0.0}), settings, {ground()}), InputError);
  EXPECT_NO_THROW(Simulator(one_particle({0.0, 1.0, 0.0}), settings));
}

TEST(Simulator, AStepThatIsNotPositiveAndFiniteIsRefused) {
  for (const double step : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(Simulator(one_particle({0.0, 0.0, 0.0}), {.step = step}), InputError) << step;
  }
}

TEST(Simulator, EverySettingOutOfBoundsIsReported) {
  SimulatorSettings settings{.air_drag = -1.0, .integrator = VerletSettings{.damping = 2.0}};
  settings.gravity.y() = std::nan("");
  settings.stretch_limit = StretchLimitSettings{.max_stretch = -0.1, .max_compression = 2.0, .iterations = 0, .tolerance = -1.0};
  settings.contact = {.stiffness = -1.0, .damping = HUGE_VAL};
  settings.air_surface = {.normal = -1.0, .tangential = std::nan("")};
  settings.wind = Wind({{0.0, Vector3(HUGE_VAL, 0, 0)}, {0.0, Vector3::Zero()}}, Gusts{.speed = -1.0, .length = 0.0});
  try {
    Simulator simulator(one_particle({0.0, 0.0, 0.0}), settings);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 15U);
  }
}

TEST(Simulator, AMeshTooLargeForItsBvhIsRefused) {
  TriangleMesh sheet;
  sheet.vertices = 1e28 * (Points(3, 3) << 0, 1, 0, 0, 0, 0, 0, 0, 1).finished();
  sheet.triangles = (Triangles(3, 1) << 0, 2, 1).finished();
  const Obstacle obstacle{.name = "sheet", .geometry = MeshGeometry{.mesh = std::make_shared<TriangleMesh>(sheet)}};
  EXPECT_THROW(Simulator(one_particle({0.25, 1.0, 0.25}), {}, {obstacle}), InputError);
}

TEST(Simulator, PositionsDoNotDependOnTheNumberOfThreads) {
  std::vector<Points> results;
  for (const int threads : {1, 2, 2}) {
    const ThreadLimit limit(threads);
    Obstacle sphere{
        .name = "sphere", .geometry = SphereGeometry{.radius = 0.3}, .material = {.friction = 0.3, .static_friction = 0.3}};
    Simulator simulator(cloth(80, 0.32, {.thickness = 0.005, .friction = 0.3, .static_friction = 0.3}),
                        {.step = 1.0 / 8000, .stretch_limit = StretchLimitSettings{}}, {sphere, ground()});
    run(simulator, 0.05);
    results.push_back(simulator.positions());
  }
  EXPECT_TRUE(results[0] == results[1]);
  EXPECT_TRUE(results[1] == results[2]);
}

TEST(Simulator, AStretchLimitAloneSupportsAHangingChain) {
  NetworkBuilder builder;
  for (int i = 0; i < 10; ++i) builder.add_particle({0.0, -0.1 * i, 0.0}, 0.01);
  for (int i = 0; i + 1 < 10; ++i) builder.add_spring(i, i + 1, 0.0, 0.1);
  builder.pin(0);
  const StretchLimitSettings limit{.max_stretch = 0.02, .iterations = 64, .tolerance = 1e-3};
  Simulator simulator(
      builder.build(),
      {.step = 1e-3, .steps_per_frame = 1000, .integrator = VerletSettings{.damping = 0.002}, .stretch_limit = limit});
  FrameRunner frames(simulator);
  frames.next_frame();
  const FrameDiagnostics frame = frames.next_frame();
  EXPECT_LE(frame.stretch_excess, 2e-3);
  EXPECT_LE(frame.max_stretch, 0.02 + 2e-3);
  EXPECT_GE(frame.max_stretch, 0.019);  // gravity stretches it to the limit
}

// The rope starts level and hangs by a pin at one end. With passes alone it would stretch to many times its length.
TEST(Simulator, NewtonKeepsTheLimitOfALongSwingingRope) {
  NetworkBuilder builder;
  constexpr int kParticles = 400;
  for (int i = 0; i < kParticles; ++i) builder.add_particle({0.0025 * i, 0.0, 0.0}, 1.0e-4);
  for (int i = 0; i + 1 < kParticles; ++i) builder.add_spring(i, i + 1, 0.0, 0.0025);
  builder.pin(0);
  const StretchLimitSettings limit{.max_stretch = 0.002, .solver = StretchLimitSettings::Solver::newton};
  Simulator simulator(builder.build(), {.step = 1.0 / 240.0, .steps_per_frame = 4, .stretch_limit = limit});
  FrameRunner frames(simulator);
  for (int frame = 0; frame < 60; ++frame) ASSERT_LE(frames.next_frame().stretch_excess, limit.tolerance) << frame;
}

// A rope is pinned at the top of a ball, lies over its side and hangs down. Its path is longer than the straight line to the pin,
// so tethers do not act before the rope hangs straight.
TEST(Simulator, TethersDoNotPullThroughObstacles) {
  NetworkBuilder builder;
  constexpr int kParticles = 40;
  builder.begin_body("rope", {.thickness = 0.01});
  for (int i = 0; i < kParticles; ++i) builder.add_particle({0.05 * i, 1.02, 0.0}, 0.01);
  for (int i = 0; i + 1 < kParticles; ++i) builder.add_spring(i, i + 1, 0.0, 0.05);
  builder.pin(0);
  Simulator simulator(builder.build(),
                      {.step = 1e-3,
                       .steps_per_frame = 50,
                       .integrator = VerletSettings{.damping = 0.002},
                       .stretch_limit = StretchLimitSettings{.tethers = true}},
                      {{.name = "ball", .geometry = SphereGeometry{.radius = 1.0}}});
  FrameRunner frames(simulator);
  for (int frame = 0; frame < 60; ++frame) {
    const FrameDiagnostics diagnostics = frames.next_frame();
    ASSERT_GE(*diagnostics.min_distance, 0.0) << frame;
    ASSERT_LE(diagnostics.max_stretch, 0.03) << frame;
  }
  // A quarter of the ball's circumference takes 31 springs. The rest of the rope hangs beside it.
  EXPECT_NEAR(simulator.positions()(1, kParticles - 1), 0.5 * std::numbers::pi * 1.01 - 0.05 * (kParticles - 1), 0.1);
}

// The pin is nearer to the floor than the contact gap. The gap yields to the stretch limit, the floor does not.
TEST(Simulator, TheStretchLimitOverridesTheContactGap) {
  constexpr double kGap = 0.02;
  constexpr double kLength = 0.005;
  NetworkBuilder builder;
  builder.begin_body("string", {.thickness = kGap});
  for (int i = 0; i < 2; ++i) builder.add_particle({0.0, 0.3 * kGap + kLength * i, 0.0}, 0.01);
  builder.add_spring(0, 1, 0.0, kLength);
  builder.pin(0);
  for (const int passes : {1, 4, 32}) {
    Simulator simulator(builder.build(), {.step = 1e-2, .stretch_limit = StretchLimitSettings{.iterations = passes}}, {ground()});
    for (int step = 0; step < 20; ++step) {
      EXPECT_LE(simulator.step().stretch_excess, 1e-12)
          << passes << " passes";  // the only spring is projected last: only rounding remains
      ASSERT_GT(simulator.positions()(1, 1), 0.0) << passes << " passes";
    }
  }
}

TEST(Simulator, ABallThatRisesBesideAPinDoesNotPassTheRodOnIt) {
  NetworkBuilder builder = rod();
  builder.pin(0);
  for (const IntegratorSettings& integrator : all_integrators()) {
    for (const int steps : {1, 4, 16, 64}) {
      Simulator simulator(
          builder.build(),
          {.step = 0.1 / steps, .gravity = Vector3::Zero(), .integrator = integrator, .stretch_limit = StretchLimitSettings{}},
          {rising_ball()});
      StepReport last;
      for (int step = 0; step < steps; ++step) {
        last = simulator.step();
        EXPECT_EQ(last.infeasible, 0) << steps;
      }
      const Vector3 end = simulator.positions().col(1);
      EXPECT_GT(0.03 * end.y() - 0.05 * end.x(), 0.0) << steps << " steps: the rod stays on the left of the ball";
      EXPECT_NEAR(last.stretch_excess, std::max(end.norm() / 0.3 - 1.02, 0.0), 1e-12)
          << steps << ": the report includes the rod's final stretch";
      EXPECT_EQ(simulator.time(), 0.1) << steps;
    }
  }
}

/// The rod is pinned at both ends, so the ball cannot pass it. Another particle flies 10 m away.
NetworkBuilder rod_and_thrown_particle() {
  NetworkBuilder builder = rod();
  builder.begin_body("thrown");
  builder.add_particle({10.0, 0.0, 0.0}, 0.1, {1.0, 2.0, 0.0});
  builder.pin({0, 1});
  return builder;
}

// No number of substeps makes the step feasible. The distant particle moves as it does without the rod and the ball.
TEST(Simulator, AnInfeasibleStepDoesNotAffectDistantParticles) {
  const NetworkBuilder builder = rod_and_thrown_particle();
  for (const IntegratorSettings& integrator : all_integrators()) {
    const SimulatorSettings settings{.step = 1e-2, .integrator = integrator};
    Simulator simulator(builder.build(), settings, {rising_ball()});
    Simulator alone(builder.build(), settings);
    int infeasible = 0;
    for (int step = 0; step < 100; ++step) {
      const StepReport report = simulator.step();
      alone.step();
      EXPECT_EQ(report.substeps, 1);
      infeasible += report.infeasible > 0 ? 1 : 0;
      ASSERT_EQ(simulator.positions().col(2), alone.positions().col(2)) << step;
    }
    EXPECT_GT(infeasible, 2);
  }
}

// If the previous step was infeasible too, each attempt with 4, 16 and 64 substeps ends after its first substep: 4 substeps
// instead of 85.
TEST(Simulator, AttemptsThatDoNotImproveEndAtOnce) {
  Simulator simulator(rod_and_thrown_particle().build(), {.step = 1e-2}, {rising_ball()});
  int substeps_made = 0;
  simulator.stop_when([&] { return ++substeps_made < 0; });
  bool infeasible_before = false;
  int attempts = 0;
  for (int step = 0; step < 100; ++step) {
    substeps_made = 0;
    const bool infeasible = simulator.step().infeasible > 0;
    if (infeasible_before && infeasible) {
      EXPECT_LE(substeps_made, 4) << step;
      attempts += substeps_made > 1 ? 1 : 0;
    }
    infeasible_before = infeasible;
  }
  EXPECT_GT(attempts, 0);
}

// In the frame of an obstacle that turns by half a turn, every particle passes through the centre.
TEST(Simulator, AFastSpinningObstacleTouchesOnlyParticlesInItsReach) {
  NetworkBuilder builder;
  for (const double x : {10.0, -1.0, 0.3}) builder.add_particle({x, 0.0, 0.0}, 0.1);
  const SpringNetwork network = builder.build();
  constexpr double kStep = 1.0 / 60.0;
  for (const double degrees : {180.0, 540.0, 900.0}) {
    const Obstacle blade{
        .name = "blade", .geometry = BoxGeometry{.size = {0.2, 0.2, 0.8}}, .motion = {.spin = {0.0, degrees / kStep, 0.0}}};
    Simulator simulator(network, {.step = kStep, .gravity = Vector3::Zero()}, {blade});
    const StepReport report = simulator.step();
    EXPECT_EQ(report.substeps, static_cast<int>(degrees / 45.0));
    EXPECT_EQ(simulator.positions().leftCols(2), network.positions.leftCols(2)) << degrees;
    EXPECT_GT((simulator.positions().col(2) - network.positions.col(2)).norm(), 0.1) << "the blade sweeps over it";
  }
}

// Two particles lie in a groove. Each slope pushes them towards the other slope, so a pass leaves a quarter of the error. One pass
// would leave 2 % of the gap after a step's fall of 4 mm. Passes end at a thousandth of the gap.
TEST(Simulator, ContactConvergesInAGrooveWithASinglePassOfTheLimit) {
  constexpr double kGap = 0.02;
  constexpr double kSteep = std::numbers::pi / 3.0;
  NetworkBuilder builder;
  builder.begin_body("string", {.thickness = kGap});
  for (int i = 0; i < 2; ++i) builder.add_particle({0.0, kGap / std::cos(kSteep), 0.1 * i}, 0.01);
  builder.add_spring(0, 1, 0.0, 0.1);
  Simulator simulator(builder.build(), {.step = 2e-2, .stretch_limit = StretchLimitSettings{.iterations = 1}},
                      {ground({}, kSteep), ground({}, -kSteep)});
  for (int step = 0; step < 20; ++step) {
    simulator.step();
    const double distance = *simulator.obstacle_frame().min_distance(simulator.positions(), 1.0);
    ASSERT_NEAR(distance, kGap, 2e-3 * kGap) << step;
  }
}

TEST(Simulator, EnergyOfAnUndampedSpringStaysBounded) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({1.2, 0.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0);
  builder.pin(hook);
  Simulator simulator(builder.build(), {.step = 1e-3, .steps_per_frame = 100, .integrator = SymplecticEulerSettings{}});
  FrameRunner frames(simulator);
  const auto total = [](const FrameDiagnostics& frame) {
    return frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy;
  };
  const double start = total(frames.first_frame());
  for (int i = 0; i < 200; ++i) {
    // The modified energy of the scheme differs from the energy by dt / 2 |v . F| <= 5e-4 * 5 m/s * 30 N.
    EXPECT_NEAR(total(frames.next_frame()), start, 0.1);
  }
}

TEST(Simulator, ASpringWithoutStiffnessMayHaveAnyLength) {
  NetworkBuilder builder;
  const Index hook = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, -1e-3, 0.0}, 1.0);
  builder.add_spring(hook, bob, 0.0, 1e-3);
  builder.pin(hook);
  Simulator simulator(builder.build(), {.step = 1e-2});
  EXPECT_NO_THROW(run(simulator, 1.0));  // 4.9 m of free fall
}

TEST(Simulator, ASpringOfLengthZeroWorks) {
  NetworkBuilder builder;
  const Index a = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  const Index b = builder.add_particle({0.0, 0.0, 0.0}, 1.0);
  builder.add_spring(a, b, 10.0, 0.0, 0.1);
  Simulator simulator(builder.build(), {.step = 1e-3, .stretch_limit = StretchLimitSettings{}});
  run(simulator, 1.0);
  EXPECT_TRUE(simulator.positions().allFinite());
  EXPECT_EQ(simulator.positions().col(a), simulator.positions().col(b));
}

}  // namespace
}  // namespace sprung
