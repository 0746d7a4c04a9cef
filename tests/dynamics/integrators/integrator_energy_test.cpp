// The effect of each scheme on the energy of an undamped oscillator: the energy grows, stays bounded, or decays.
#include "dynamics/oscillator.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

constexpr Oscillator kFree{};

/// The energy after each of `steps` steps as a fraction of the initial energy.
std::vector<double> energy_ratios(const IntegratorSettings& settings, double dt, int steps) {
  OscillatorRun run(kFree, settings, dt);
  const double start = kFree.energy(run.x(), run.v());
  std::vector<double> ratios;
  for (int step = 0; step < steps; ++step) {
    run.step();
    ratios.push_back(kFree.energy(run.x(), run.v()) / start);
  }
  return ratios;
}

/// Each step multiplies the energy by `factor`. Positions near 1 are rounded by 1e-16, 1e-15 of the amplitude, a few times a step.
void expect_geometric(const std::vector<double>& ratios, double factor) {
  for (std::size_t step = 0; step < ratios.size(); ++step) {
    const double exponent = static_cast<double>(step + 1);
    ASSERT_NEAR(ratios[step] / std::pow(factor, exponent), 1.0, 1.0e-14 * (exponent + 10.0));
  }
}

// |1 + i y|^2, y = omega dt.
TEST(ExplicitEuler, GainsEnergyAtItsAnalyticRate) {
  const double dt = 1.0e-2;
  expect_geometric(energy_ratios(ExplicitEulerSettings{}, dt, 500), 1.0 + std::pow(kFree.omega() * dt, 2));
}

// |1 - i y|^-2. Symplectic Euler, below, is the negative control.
TEST(ImplicitEuler, LosesEnergyAtItsAnalyticRate) {
  const double dt = 1.0e-2;
  expect_geometric(energy_ratios(ImplicitEulerSettings{}, dt, 500), 1.0 / (1.0 + std::pow(kFree.omega() * dt, 2)));
}

// |1 + i y - y^2 / 2 - i y^3 / 6 + y^4 / 24|^2 = 1 - y^6 / 72 + y^8 / 576: the loss in a given time decreases with the fifth power
// of the step.
TEST(RungeKutta4, LosesEnergyAtItsAnalyticRate) {
  for (const double dt : {0.05, 0.1, 0.2}) {
    const double y = kFree.omega() * dt;
    expect_geometric(energy_ratios(RungeKutta4Settings{}, dt, 500), 1.0 - std::pow(y, 6) / 72.0 + std::pow(y, 8) / 576.0);
  }
}

// Symplectic Euler and Verlet have velocities half a step off the positions; with q = omega dt / 2 their energy differs from E by
// at most q E. Velocity Verlet conserves m v^2 / 2 + (1 - q^2) k (x - d)^2 / 2. Explicit Euler is the negative control.
TEST(Integrators, OfSymplecticKindKeepEnergyBoundedOverAThousandPeriods) {
  const double dt = 1.0e-2;
  const double q = 0.5 * kFree.omega() * dt;
  const auto expect_bounded = [&](const IntegratorSettings& settings, double bound) {
    for (const double ratio : energy_ratios(settings, dt, 200'000)) {
      ASSERT_LE(ratio, bound * (1.0 + 1e-9));
      ASSERT_GE(ratio, (1.0 - 1e-9) / bound);
    }
  };
  expect_bounded(SymplecticEulerSettings{}, (1.0 + q) / (1.0 - q));
  expect_bounded(VerletSettings{}, (1.0 + q) / (1.0 - q));
  expect_bounded(VelocityVerletSettings{}, 1.0 / (1.0 - q * q));
  EXPECT_GT(energy_ratios(ExplicitEulerSettings{}, dt, 1000).back(), 2.0);
}

}  // namespace
}  // namespace sprung
