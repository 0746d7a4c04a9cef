// The times at which schemes evaluate forces: under a force m t^p alone, v is a quadrature rule.
#include "dynamics/integrators/integrator.h"
#include "dynamics/state/simulation_state.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace sprung {
namespace {

class PowerOfTime final : public Force {
 public:
  explicit PowerOfTime(double power) : power_(power) {}
  void add(const Kinematics& at, Points& forces) const override { forces.row(0).array() += std::pow(at.time, power_); }

 private:
  double power_;
};

constexpr int kSteps = 8;
constexpr double kStep = 0.125;

/// Velocity of a mass of 1 kg after a second under t^p N, from rest.
double velocity_after_a_second(const IntegratorSettings& settings, double power) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  const SpringNetwork network = builder.build();
  Forces forces;
  forces.push_back(std::make_unique<PowerOfTime>(power));
  const auto integrator = make_integrator(settings, network);
  SimulationState state = initial_state(network);
  integrator->start(state, forces, kStep);
  for (; state.step < kSteps; count_step(state)) integrator->advance(state, forces, kStep);
  return state.v(0, 0);
}

// The tolerance is for sums of at most 32 terms below 1.
constexpr double kRounding = 32 * std::numeric_limits<double>::epsilon();

// sum dt (k dt) = (1 - dt) / 2 over steps k from 0.
TEST(IntegratorsInTime, EulersAndVerletUseTheForceAtTheBeginningOfTheStep) {
  for (const IntegratorSettings& settings :
       {IntegratorSettings{ExplicitEulerSettings{}}, {SymplecticEulerSettings{}}, {VerletSettings{}}}) {
    EXPECT_NEAR(velocity_after_a_second(settings, 1.0), 0.5 * (1.0 - kStep), kRounding);
  }
}

TEST(IntegratorsInTime, ImplicitEulerUsesTheForceAtTheEndOfTheStep) {
  EXPECT_NEAR(velocity_after_a_second(ImplicitEulerSettings{}, 1.0), 0.5 * (1.0 + kStep), kRounding);
}

// Exact for t; (1 / 12) dt^2 f'(1) too large for t^2.
TEST(IntegratorsInTime, VelocityVerletIsTheTrapezoidalRule) {
  EXPECT_NEAR(velocity_after_a_second(VelocityVerletSettings{}, 1.0), 1.0 / 2.0, kRounding);
  EXPECT_NEAR(velocity_after_a_second(VelocityVerletSettings{}, 2.0), 1.0 / 3.0 + kStep * kStep / 6.0, kRounding);
}

// Exact up to t^3; dt^4 / 120 too large for t^4.
TEST(IntegratorsInTime, RungeKutta4IsSimpsonsRule) {
  for (const double power : {1.0, 2.0, 3.0}) {
    EXPECT_NEAR(velocity_after_a_second(RungeKutta4Settings{}, power), 1.0 / (power + 1.0), kRounding);
  }
  EXPECT_NEAR(velocity_after_a_second(RungeKutta4Settings{}, 4.0), 1.0 / 5.0 + std::pow(kStep, 4) / 120.0, kRounding);
}

}  // namespace
}  // namespace sprung
