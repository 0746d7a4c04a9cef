#include "dynamics/integrators/integrator.h"

#include "base/parallel.h"
#include "dynamics/all_integrators.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/networks.h"
#include "dynamics/oscillator.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

constexpr Oscillator kDamped{.damping = 0.4, .gravity = 1.5};
constexpr double kRecurrence = 1.0e-12;  // rounding of 1,000 steps, which neither grow nor shrink by much

TEST(ExplicitEuler, FollowsEquationOne) {
  const double dt = 1.0e-3;
  OscillatorRun run(kDamped, ExplicitEulerSettings{}, dt);
  double x = kDamped.start;
  double v = kDamped.start_velocity;
  for (int step = 0; step < 1000; ++step) {
    const double a = kDamped.acceleration(x, v);
    x += v * dt;
    v += a * dt;
    run.step();
    ASSERT_NEAR(run.x(), x, kRecurrence);
    ASSERT_NEAR(run.v(), v, kRecurrence);
  }
}

TEST(SymplecticEuler, MovesWithTheNewVelocity) {
  const double dt = 1.0e-2;
  OscillatorRun run(kDamped, SymplecticEulerSettings{}, dt);
  double x = kDamped.start;
  double v = kDamped.start_velocity;
  for (int step = 0; step < 1000; ++step) {
    v += kDamped.acceleration(x, v) * dt;
    x += v * dt;
    run.step();
    ASSERT_NEAR(run.x(), x, kRecurrence);
    ASSERT_NEAR(run.v(), v, kRecurrence);
  }
}

TEST(Verlet, FollowsThePrintedFormula) {
  const double dt = 1.0e-2;
  const double damping = 0.01;
  OscillatorRun run(kDamped, VerletSettings{.damping = damping}, dt);
  double x = kDamped.start;
  double v = kDamped.start_velocity;
  double previous = x - v * dt + 0.5 * kDamped.acceleration(x, v) * dt * dt;
  for (int step = 0; step < 1000; ++step) {
    const double next = x + (1.0 - damping) * (x - previous) + kDamped.acceleration(x, v) * dt * dt;
    previous = x;
    x = next;
    v = (x - previous) / dt;
    run.step();
    ASSERT_NEAR(run.x(), x, kRecurrence);
    ASSERT_NEAR(run.v(), v, kRecurrence / dt);  // a difference of positions, divided by the step
  }
}

TEST(Verlet, StartsAtRestLikeTheWebPageIfRequested) {
  OscillatorRun run(kDamped, VerletSettings{.start_at_rest = true}, 1.0e-2);
  run.step();
  const double expected = kDamped.start + kDamped.acceleration(kDamped.start, kDamped.start_velocity) * 1.0e-4;
  EXPECT_NEAR(run.x(), expected, 1.0e-15);
}

TEST(Verlet, DampingRateDoesNotDependOnTheStep) {
  // Without forces each step keeps exp(-rate dt) of the velocity: exp(-rate t) after any number of steps.
  for (const double dt : {0.1, 0.01, 0.001}) {
    const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
    SimulationState state = initial_state(network);
    state.v.col(1) = Vector3(0.0, 2.0, 0.0);
    const auto integrator = make_integrator(VerletSettings{.damping_rate = 3.0}, network);
    integrator->start(state, {}, dt);
    for (; state.step < std::lround(1.0 / dt); ++state.step) integrator->advance(state, {}, dt);
    EXPECT_NEAR(state.v(1, 1), 2.0 * std::exp(-3.0), 1.0e-12 / dt);
  }
}

TEST(Integrators, GiveTheSpringItsPeriod) {
  const Oscillator free{.start_velocity = 0.0};
  const double period = 2.0 * std::numbers::pi / free.omega();
  const double dt = period / 1000.0;
  for (const IntegratorSettings& settings : {IntegratorSettings{SymplecticEulerSettings{}}, IntegratorSettings{VerletSettings{}},
                                             IntegratorSettings{VelocityVerletSettings{}}}) {
    OscillatorRun run(free, settings, dt);
    // Counts upward passages through the rest length, interpolated: the first and the eleventh are ten periods apart.
    std::vector<double> passages;
    for (int step = 1; passages.size() < 11; ++step) {
      const double before = run.x() - free.rest_length;
      run.step();
      const double after = run.x() - free.rest_length;
      if (before < 0.0 && after >= 0.0) passages.push_back((step - after / (after - before)) * dt);
    }
    // All three have sin(omega' dt / 2) = omega dt / 2: the period is 1 - (omega dt)^2 / 24 = 1 - 1.6e-6 of the true one.
    EXPECT_NEAR((passages.back() - passages.front()) / 10.0 / period, 1.0, 3.0e-6);
  }
}

TEST(Integrators, DampedSpringsDecayInTheirEnvelope) {
  const Oscillator damped{.damping = 0.2, .start_velocity = 0.0};
  const double decay = 0.5 * damped.damping / damped.mass;
  const double dt = 1.0e-4;
  for (const IntegratorSettings& settings : {IntegratorSettings{SymplecticEulerSettings{}}, IntegratorSettings{VerletSettings{}}}) {
    OscillatorRun run(damped, settings, dt);
    const double amplitude = std::abs(damped.start - damped.rest_length);
    double largest_late = 0.0;
    for (int step = 1; step <= 80000; ++step) {
      run.step();
      // The envelope of a release from rest is amplitude / cos(phase) exp(-decay t), where sin(phase) = decay / omega.
      const double envelope = amplitude / std::sqrt(1.0 - std::pow(decay / damped.omega(), 2)) * std::exp(-decay * step * dt);
      ASSERT_LE(std::abs(run.x() - damped.rest_length), envelope * (1.0 + 2.0 * damped.omega() * dt));
      if (step > 70000) largest_late = std::max(largest_late, std::abs(run.x() - damped.rest_length) / envelope);
    }
    EXPECT_GT(largest_late, 0.99) << "the oscillation reaches its envelope";
  }
}

TEST(Integrators, LeavePinnedParticlesUnchanged) {
  const SpringNetwork network = make_test_cloth(6, 100.0, 0.1);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  for (const IntegratorSettings& settings : all_integrators()) {
    SimulationState state = initial_state(network);
    state.v.col(30) = Vector3(1.0, 2.0, 3.0);  // a pin that moves
    const auto integrator = make_integrator(settings, network);
    integrator->start(state, forces, 0.01);
    const SimulationState before = state;
    integrator->advance(state, forces, 0.01);
    integrator->recover_velocities(state, forces, before.x, Points::Constant(3, 36, 7.0), 0.01);
    for (const Index pinned : {30, 35}) {
      EXPECT_EQ(state.x.col(pinned), before.x.col(pinned));
      EXPECT_EQ(state.v.col(pinned), before.v.col(pinned));
      EXPECT_EQ(state.x_previous.col(pinned), before.x_previous.col(pinned));
    }
  }
}

// The simulator does not copy these positions.
TEST(Integrators, KeepThePreviousPositionsIfTheyReportIt) {
  const SpringNetwork network = make_test_cloth(6, 0.0, 0.0);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  for (const IntegratorSettings& settings : all_integrators()) {
    SimulationState state = initial_state(network);
    const auto integrator = make_integrator(settings, network);
    EXPECT_EQ(integrator->keeps_positions(), std::holds_alternative<VerletSettings>(settings));
    if (!integrator->keeps_positions()) continue;
    integrator->start(state, forces, 0.01);
    for (int step = 0; step < 3; ++step) {
      state.x.col(30) += Vector3(0.1, 0.0, 0.0);  // a pin that moves
      const Points before = state.x;
      integrator->advance(state, forces, 0.01);
      EXPECT_EQ(state.x_previous, before);
      EXPECT_NE(state.x, before);
    }
  }
}

TEST(Integrators, RecoverVelocitiesFromConstrainedPositions) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  const double dt = 0.5;
  for (const IntegratorSettings& settings : all_integrators()) {
    SimulationState state = initial_state(network);
    state.v.col(0) = Vector3(1.0, 0.0, 0.0);
    const auto integrator = make_integrator(settings, network);
    integrator->start(state, {}, dt);
    const Points before = state.x;
    integrator->advance(state, {}, dt);
    const Points advanced = state.x;
    const Vector3 velocity = state.v.col(0);
    state.x(1, 0) += 0.25;
    integrator->recover_velocities(state, {}, before, advanced, dt);
    EXPECT_EQ(state.v.col(0), velocity + Vector3(0.0, 0.5, 0.0));
    EXPECT_EQ(state.v.col(1), Vector3::Zero());
  }
}

TEST(Verlet, ContinuesWithAVelocityThatContactChanged) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  SimulationState state = initial_state(network);
  const auto integrator = make_integrator(VerletSettings{}, network);
  integrator->start(state, {}, 0.5);
  state.v.col(1) = Vector3(0.0, 4.0, 0.0);
  integrator->velocity_changed(state, 1, 0.5);
  integrator->advance(state, {}, 0.5);
  EXPECT_EQ(state.x.col(1), Vector3(1.0, 2.0, 0.0));
}

TEST(Integrators, HaveTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork network = make_test_cloth(100, 100.0, 0.1);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  forces.push_back(std::make_unique<SpringForce>(network));
  forces.push_back(std::make_unique<AirDrag>(network, 0.1, Vector3(1.0, 0.0, 2.0)));
  for (const IntegratorSettings& settings : all_integrators()) {
    const auto ten_steps = [&](int threads) {
      const ThreadLimit limit(threads);
      SimulationState state = initial_state(network);
      const auto integrator = make_integrator(settings, network);
      integrator->start(state, forces, 1e-3);
      for (; state.step < 10; ++state.step) integrator->advance(state, forces, 1e-3);
      return state.x;
    };
    EXPECT_EQ(ten_steps(1), ten_steps(2));
  }
}

}  // namespace
}  // namespace sprung
