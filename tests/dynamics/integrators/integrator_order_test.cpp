// The order of each scheme: on an oscillator with a closed form, and on damped springs that rotate and stretch.
#include "dynamics/oscillator.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <vector>

namespace sprung {
namespace {

/// A moving pin and three masses that whirl around it on damped springs, in wind.
class Whirl {
 public:
  explicit Whirl(double damping) {
    NetworkBuilder builder;
    const Index pin = builder.add_particle(Vector3::Zero(), 1.0);
    const Index a = builder.add_particle(Vector3(1.2, 0.0, 0.0), 0.5, Vector3(0.0, 1.0, 2.0));
    const Index b = builder.add_particle(Vector3(0.5, 1.0, 0.2), 0.3, Vector3(1.0, 0.0, -1.0));
    const Index c = builder.add_particle(Vector3(0.3, 0.2, 1.1), 0.4, Vector3(-1.0, 2.0, 0.0));
    builder.add_spring(pin, a, 20.0, 1.0, damping);
    builder.add_spring(a, b, 15.0, 0.9, damping);
    builder.add_spring(b, c, 25.0, 1.2, damping);
    builder.add_spring(a, c, 10.0, 1.0, damping);
    builder.pin(pin);
    network_ = builder.build();
    forces_.push_back(std::make_unique<Gravity>(network_, Vector3(0.0, -9.81, 0.0)));
    forces_.push_back(std::make_unique<SpringForce>(network_));
    forces_.push_back(std::make_unique<AirDrag>(network_, 0.2 * damping, Vector3(3.0, 0.0, 1.0)));
  }

  /// Positions after a second in so many steps.
  [[nodiscard]] Points after_a_second(const IntegratorSettings& settings, int steps) const {
    const double dt = 1.0 / steps;
    SimulationState state = initial_state(network_);
    state.v.col(0) = Vector3(0.5, 0.3, -0.4);
    const auto integrator = make_integrator(settings, network_);
    integrator->start(state, forces_, dt);
    for (; state.step < steps; ++state.step) {
      integrator->advance(state, forces_, dt);
      state.x.col(0) += dt * state.v.col(0);
    }
    return state.x;
  }

 private:
  SpringNetwork network_;
  Forces forces_;
};

// The error is C h^p (1 + a h + ...), so the slope from h to h / 2 is p + a' h + .... Twice the slope of the next halving minus
// this slope is p + O(h^2). It is without a' h, which is less than 0.1 here; a tenth of the square of that remains.
void expect_order(double order, const std::function<double(int)>& error, int steps) {
  const double first = std::log2(error(steps) / error(2 * steps));
  const double second = std::log2(error(2 * steps) / error(4 * steps));
  EXPECT_LT(std::abs(first - second), 0.1);
  EXPECT_NEAR(2.0 * second - first, order, 0.02);
}

void expect_whirl_order(double order, const IntegratorSettings& settings, double damping, int steps) {
  const Whirl whirl(damping);
  // RK4's own error at this step is below 1e-12, a hundredth of the smallest measured error.
  const Points reference = whirl.after_a_second(RungeKutta4Settings{}, 8192);
  expect_order(
      order, [&](int n) { return (whirl.after_a_second(settings, n) - reference).norm(); }, steps);
}

TEST(ExplicitEuler, IsOfFirstOrder) { expect_whirl_order(1.0, ExplicitEulerSettings{}, 1.0, 2048); }
TEST(SymplecticEuler, IsOfFirstOrder) { expect_whirl_order(1.0, SymplecticEulerSettings{}, 1.0, 2048); }
TEST(Verlet, IsOfSecondOrderWithoutDampers) { expect_whirl_order(2.0, VerletSettings{}, 0.0, 512); }
TEST(Verlet, IsOfFirstOrderWithDampersThatSeeTheVelocityOfHalfAStepAgo) { expect_whirl_order(1.0, VerletSettings{}, 1.0, 2048); }
TEST(VelocityVerlet, IsOfSecondOrderWithDampersToo) {
  expect_whirl_order(2.0, VelocityVerletSettings{}, 0.0, 512);
  expect_whirl_order(2.0, VelocityVerletSettings{}, 1.0, 512);
}
TEST(RungeKutta4, IsOfFourthOrder) {
  expect_whirl_order(4.0, RungeKutta4Settings{}, 0.0, 128);
  expect_whirl_order(4.0, RungeKutta4Settings{}, 1.0, 128);
}

TEST(ImplicitEuler, IsOfFirstOrder) {
  expect_whirl_order(1.0, ImplicitEulerSettings{}, 0.0, 2048);
  expect_whirl_order(1.0, ImplicitEulerSettings{}, 1.0, 2048);
}

// The reference above is one of our schemes; an oscillator has a closed form.
TEST(Integrators, ConvergeToTheClosedFormOfAnOscillator) {
  const Oscillator damped{.damping = 0.4, .gravity = 1.5};
  const auto expect_oscillator_order = [&](double order, const IntegratorSettings& settings, int steps) {
    const auto error = [&](int n) {
      OscillatorRun run(damped, settings, 1.0 / n);
      for (int step = 0; step < n; ++step) run.step();
      return std::abs(run.x() - damped.exact(1.0));
    };
    expect_order(order, error, steps);
  };
  expect_oscillator_order(1.0, ExplicitEulerSettings{}, 2048);
  expect_oscillator_order(1.0, SymplecticEulerSettings{}, 2048);
  expect_oscillator_order(1.0, VerletSettings{}, 2048);
  expect_oscillator_order(2.0, VelocityVerletSettings{}, 256);
  expect_oscillator_order(4.0, RungeKutta4Settings{}, 32);
  expect_oscillator_order(1.0, ImplicitEulerSettings{}, 2048);
}

}  // namespace
}  // namespace sprung
