#include "dynamics/integrator.h"

#include "base/parallel.h"
#include "dynamics/body_forces.h"
#include "dynamics/networks.h"
#include "dynamics/spring_force.h"
#include "network/simulation_state.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

/// A mass on a spring along x, the other end pinned at 0, in a gravity along x: x'' = -k/m (x - d) - c/m x' + g.
struct Oscillator {
  double mass = 0.5;
  double stiffness = 8.0;
  double rest_length = 1.0;
  double damping = 0.0;
  double gravity = 0.0;
  double start = 1.2;
  double start_velocity = 0.3;

  [[nodiscard]] double acceleration(double x, double v) const {
    return (-stiffness * (x - rest_length) - damping * v) / mass + gravity;
  }
  [[nodiscard]] double energy(double x, double v) const {
    return 0.5 * mass * v * v + 0.5 * stiffness * (x - rest_length) * (x - rest_length);
  }
  [[nodiscard]] double omega() const { return std::sqrt(stiffness / mass); }

  /// Closed form, underdamped.
  [[nodiscard]] double exact(double t) const {
    const double middle = rest_length + gravity * mass / stiffness;
    const double decay = 0.5 * damping / mass;
    const double frequency = std::sqrt(stiffness / mass - decay * decay);
    const double a = start - middle;
    const double b = (start_velocity + decay * a) / frequency;
    return middle + std::exp(-decay * t) * (a * std::cos(frequency * t) + b * std::sin(frequency * t));
  }
};

/// The oscillator, run by an integrator of ours.
class OscillatorRun {
 public:
  OscillatorRun(const Oscillator& of, const IntegratorSettings& settings, double dt)
      : network_(make_pair(of.start, of.stiffness, of.rest_length, of.damping, true, of.mass)), dt_(dt) {
    network_.velocities(0, 1) = of.start_velocity;
    forces_.push_back(std::make_unique<SpringForce>(network_));
    forces_.push_back(std::make_unique<Gravity>(network_, Vector3(of.gravity, 0.0, 0.0)));
    state_ = initial_state(network_);
    integrator_ = make_integrator(settings, network_);
    integrator_->start(state_, forces_, dt_);
  }

  void step() {
    integrator_->advance(state_, forces_, dt_, scratch_);
    ++state_.step;
  }
  [[nodiscard]] double x() const { return state_.x(0, 1); }
  [[nodiscard]] double v() const { return state_.v(0, 1); }

 private:
  SpringNetwork network_;
  Forces forces_;
  std::unique_ptr<Integrator> integrator_;
  SimulationState state_;
  Points scratch_;
  double dt_;
};

constexpr Oscillator kDamped{.damping = 0.4, .gravity = 1.5};
constexpr double kRecurrence = 1.0e-12;  // 1,000 steps of a few roundings each, neither growing nor shrinking by much

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

TEST(Verlet, StartsAtRestAsTheWebPageWhenAsked) {
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
    Points scratch;
    for (; state.step < std::lround(1.0 / dt); ++state.step) integrator->advance(state, {}, dt, scratch);
    EXPECT_NEAR(state.v(1, 1), 2.0 * std::exp(-3.0), 1.0e-12 / dt);
  }
}

double error_at_one_second(const Oscillator& of, const IntegratorSettings& settings, int steps) {
  OscillatorRun run(of, settings, 1.0 / steps);
  for (int step = 0; step < steps; ++step) run.step();
  return std::abs(run.x() - of.exact(1.0));
}

double measured_order(const Oscillator& of, const IntegratorSettings& settings) {
  return std::log2(error_at_one_second(of, settings, 2000) / error_at_one_second(of, settings, 4000));
}

// Errors are C dt^p (1 + O(dt)): at 1/2000 s the slope is within a few parts in a hundred of p.
TEST(Integrators, ConvergeWithTheirOrder) {
  const Oscillator free{};
  EXPECT_NEAR(measured_order(free, ExplicitEulerSettings{}), 1.0, 0.05);
  EXPECT_NEAR(measured_order(free, SymplecticEulerSettings{}), 1.0, 0.05);
  EXPECT_NEAR(measured_order(free, VerletSettings{}), 2.0, 0.05);
  EXPECT_NEAR(measured_order(kDamped, ExplicitEulerSettings{}), 1.0, 0.05);
  EXPECT_NEAR(measured_order(kDamped, SymplecticEulerSettings{}), 1.0, 0.05);
  EXPECT_NEAR(measured_order(kDamped, VerletSettings{}), 1.0, 0.05) << "dampers see the velocity of half a step ago";
}

TEST(Integrators, GiveTheSpringItsPeriod) {
  const Oscillator free{.start_velocity = 0.0};
  const double period = 2.0 * std::numbers::pi / free.omega();
  const double dt = period / 1000.0;
  for (const IntegratorSettings& settings : {IntegratorSettings{SymplecticEulerSettings{}}, IntegratorSettings{VerletSettings{}}}) {
    OscillatorRun run(free, settings, dt);
    // Counts upward passages through the rest length, interpolated: the first and the eleventh are ten periods apart.
    std::vector<double> passages;
    for (int step = 1; passages.size() < 11; ++step) {
      const double before = run.x() - free.rest_length;
      run.step();
      const double after = run.x() - free.rest_length;
      if (before < 0.0 && after >= 0.0) passages.push_back((step - after / (after - before)) * dt);
    }
    // Both schemes have sin(omega' dt / 2) = omega dt / 2: the period is 1 - (omega dt)^2 / 24 = 1 - 1.6e-6 of the true one.
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
    EXPECT_GT(largest_late, 0.99) << "the envelope is touched";
  }
}

TEST(ExplicitEuler, GainsEnergyAtItsAnalyticRate) {
  const Oscillator free{};
  const double dt = 1.0e-2;
  OscillatorRun run(free, ExplicitEulerSettings{}, dt);
  double expected = free.energy(run.x(), run.v());
  const double gain = 1.0 + std::pow(free.omega() * dt, 2);
  for (int step = 0; step < 500; ++step) {
    run.step();
    expected *= gain;
    ASSERT_NEAR(free.energy(run.x(), run.v()) / expected, 1.0, 1.0e-12);
  }
}

// Symplectic Euler keeps E - k dt (x - d) v / 2, and that differs from E by at most q E, q = omega dt / 2. Explicit Euler is the
// negative control.
TEST(SymplecticEuler, KeepsEnergyBounded) {
  const Oscillator free{};
  const double dt = 1.0e-2;
  const double q = 0.5 * free.omega() * dt;
  const double bound = (1.0 + q) / (1.0 - q);
  OscillatorRun symplectic(free, SymplecticEulerSettings{}, dt);
  OscillatorRun explicit_euler(free, ExplicitEulerSettings{}, dt);
  const double start = free.energy(symplectic.x(), symplectic.v());
  for (int step = 0; step < 100000; ++step) {
    symplectic.step();
    const double ratio = free.energy(symplectic.x(), symplectic.v()) / start;
    ASSERT_LE(ratio, bound * (1.0 + 1e-9));
    ASSERT_GE(ratio, (1.0 - 1e-9) / bound);
    if (step < 1000) explicit_euler.step();
  }
  EXPECT_GT(free.energy(explicit_euler.x(), explicit_euler.v()) / start, 2.0 * bound);
}

const std::vector<IntegratorSettings> kAll{ExplicitEulerSettings{}, SymplecticEulerSettings{}, VerletSettings{.damping = 0.01}};

TEST(Integrators, LeavePinnedParticlesAlone) {
  const SpringNetwork network = make_test_cloth(6, 100.0, 0.1);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  for (const IntegratorSettings& settings : kAll) {
    SimulationState state = initial_state(network);
    state.v.col(30) = Vector3(1.0, 2.0, 3.0);  // a pin that moves
    const auto integrator = make_integrator(settings, network);
    integrator->start(state, forces, 0.01);
    const SimulationState before = state;
    Points scratch;
    integrator->advance(state, forces, 0.01, scratch);
    integrator->recover_velocities(state, before.x, Points::Constant(3, 36, 7.0), 0.01);
    for (const Index pinned : {30, 35}) {
      EXPECT_EQ(state.x.col(pinned), before.x.col(pinned));
      EXPECT_EQ(state.v.col(pinned), before.v.col(pinned));
      EXPECT_EQ(state.x_previous.col(pinned), before.x_previous.col(pinned));
    }
  }
}

TEST(Integrators, RecoverVelocitiesFromWhatConstraintsMoved) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  const double dt = 0.5;
  for (const IntegratorSettings& settings : kAll) {
    SimulationState state = initial_state(network);
    state.v.col(0) = Vector3(1.0, 0.0, 0.0);
    const auto integrator = make_integrator(settings, network);
    integrator->start(state, {}, dt);
    const Points before = state.x;
    Points scratch;
    integrator->advance(state, {}, dt, scratch);
    const Points advanced = state.x;
    const Vector3 velocity = state.v.col(0);
    state.x(1, 0) += 0.25;
    integrator->recover_velocities(state, before, advanced, dt);
    EXPECT_EQ(state.v.col(0), velocity + Vector3(0.0, 0.5, 0.0));
    EXPECT_EQ(state.v.col(1), Vector3::Zero());
  }
}

TEST(Verlet, GoesOnWithAVelocityThatContactChanged) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  SimulationState state = initial_state(network);
  const auto integrator = make_integrator(VerletSettings{}, network);
  integrator->start(state, {}, 0.5);
  state.v.col(1) = Vector3(0.0, 4.0, 0.0);
  integrator->velocity_changed(state, 1, 0.5);
  Points scratch;
  integrator->advance(state, {}, 0.5, scratch);
  EXPECT_EQ(state.x.col(1), Vector3(1.0, 2.0, 0.0));
}

TEST(Integrators, HaveTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork network = make_test_cloth(100, 100.0, 0.1);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  forces.push_back(std::make_unique<SpringForce>(network));
  forces.push_back(std::make_unique<AirDrag>(network, 0.1, Vector3(1.0, 0.0, 2.0)));
  for (const IntegratorSettings& settings : kAll) {
    const auto ten_steps = [&](int threads) {
      const ThreadLimit limit(threads);
      SimulationState state = initial_state(network);
      const auto integrator = make_integrator(settings, network);
      integrator->start(state, forces, 1e-3);
      Points scratch;
      for (; state.step < 10; ++state.step) integrator->advance(state, forces, 1e-3, scratch);
      return state.x;
    };
    EXPECT_EQ(ten_steps(1), ten_steps(2));
  }
}

}  // namespace
}  // namespace sprung
