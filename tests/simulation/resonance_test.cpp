// A step below the largest stable one can explode by resonance. The advised step does not.
#include "dynamics/network_bounds.h"
#include "simulation/scenes.h"
#include "simulation/step/step_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

constexpr double kSpeed = 30.0;  // [m/s] of the cloth's waves: the cloth crumples

/// A tilted cloth of 1 m and 0.2 kg that flies towards the sheet.
SpringNetwork thrown_cloth(double damping_time) {
  const auto spring = [&](double stiffness) { return SpringMaterial{.value = stiffness, .damping = damping_time * stiffness}; };
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {21, 21}},
                               {.structural = spring(200.0), .shear = spring(100.0), .bend = spring(5.0)});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({20.0, 15.0, 10.0});
  pose.translation() = Vector3(0.0, 0.6, 0.0);
  place(shape, pose, Vector3(0.0, -kSpeed, 0.0));
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = 0.005});
  return builder.build();
}

/// The sum of kinetic and elastic energy 1 s after the impact, divided by the sum just after it.
double growth(const SpringNetwork& network, const IntegratorSettings& integrator, double step) {
  Simulator simulator(network, {.step = step, .gravity = Vector3::Zero(), .integrator = integrator}, {testing::sheet(1.0)});
  const auto energy = [&] {
    return 0.5 * network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) + simulator.elastic_energy();
  };
  testing::run(simulator, 0.02);
  EXPECT_GT(simulator.contact_count(), 0) << "the cloth hits the sheet";
  testing::run(simulator, 0.18);
  const double begin = energy();
  testing::run(simulator, 1.0);
  return energy() / begin;
}

double advised(const SpringNetwork& network, const IntegratorSettings& integrator) {
  return advised_step(integrator, spectral_bounds(network));
}

// Leapfrog conserves a modified energy. It differs from the true one by at most (omega dt)^2 / 8 of the energy of the fastest
// mode.
TEST(Resonance, DoesNotHeatACrumpledClothAtTheAdvisedStep) {
  const SpringNetwork network = thrown_cloth(0.0);
  for (const IntegratorSettings& integrator : {IntegratorSettings(SymplecticEulerSettings{}), IntegratorSettings(VerletSettings{}),
                                               IntegratorSettings(VelocityVerletSettings{})}) {
    EXPECT_LT(growth(network, integrator, advised(network, integrator)), 1.125) << integrator.index();
  }
}

TEST(Resonance, ExplodesBelowTheLargestStableStep) {
  const SpringNetwork network = thrown_cloth(0.0);
  EXPECT_GT(
      growth(network, SymplecticEulerSettings{}, 0.88 * largest_stable_step(SymplecticEulerSettings{}, spectral_bounds(network))),
      10.0);
}

TEST(Resonance, IsOutweighedByDampingOfOnePerCent) {
  const double omega = std::sqrt(spectral_bounds(thrown_cloth(0.0)).elastic);
  const SpringNetwork network = thrown_cloth(2.0 * kHardlyDamped / omega);
  const double step = advised(network, SymplecticEulerSettings{});
  EXPECT_GT(step * omega, std::numbers::sqrt3) << "the step can be resonant";
  EXPECT_LT(growth(network, SymplecticEulerSettings{}, step), 1.0);
}

}  // namespace
}  // namespace sprung
