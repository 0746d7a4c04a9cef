// Materials whose motion depends neither on a body's resolution nor on the step.
#include "simulation/scenes.h"
#include "simulation/simulator.h"
#include "simulation/step/step_check.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

using testing::run;

constexpr double kDensity = 0.2;  // [kg/m^2] of cloths, [kg/m] of ropes

SpringMaterial modulus(double value, std::optional<double> damping_ratio = {}) {
  return {.value = value, .measure = SpringMaterial::Measure::modulus, .damping_ratio = damping_ratio};
}

/// A cloth of 1 m and side x side particles in the plane y = 0, pinned at its corners or along two opposite edges.
SpringNetwork level_cloth(Index side, bool by_corners, double structural) {
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {side, side}},
                               {.structural = modulus(structural), .shear = modulus(0.25 * structural)});
  set_density(shape, kDensity);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  const Index last_row = side * (side - 1);
  for (Index i = 0; i < side; ++i) {
    if (by_corners && i != 0 && i + 1 != side) continue;
    builder.pin(i);
    if (!by_corners) builder.pin(last_row + i);
  }
  return builder.build();
}

/// A rope of 1 m along x, pinned at its first particle and, if `both_ends`, at its last.
SpringNetwork level_rope(Index particles, const SpringMaterial& structural, bool both_ends) {
  BodyShape shape =
      make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = particles, .length = {}}, {.structural = structural});
  set_density(shape, kDensity);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin(0);
  if (both_ends) builder.pin(particles - 1);
  return builder.build();
}

/// The distance [m] of the lowest particle below y = 0 after `seconds`. It is at rest then if the damping is near critical. The
/// step is `fraction` of the largest stable one.
double sag(const SpringNetwork& network, double seconds, double damping_rate, double fraction = 0.9) {
  SimulatorSettings settings{.integrator = VerletSettings{.damping_rate = damping_rate}};
  settings.step = fraction * largest_stable_step(settings.integrator, simulation_bounds(network, settings, false));
  Simulator simulator(network, settings);
  run(simulator, seconds);
  return -simulator.positions().row(1).minCoeff();
}

double spread(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most / *least - 1.0;
}

// Measured: 0.35 %. The slowest mode's rate is pi / L sqrt(T / density) = 8.6 1/s with T = weight L / (8 sag). After 1 s of
// critical damping 0.2 % of the amplitude remains at each resolution.
TEST(Materials, AClothPinnedAtTwoEdgesSagsAlikeAtAnyResolution) {
  std::vector<double> sags;
  for (const Index side : {16, 32, 64, 128}) sags.push_back(sag(level_cloth(side, false, 20.0), 1.0, 17.0));
  EXPECT_LT(spread(sags), 0.03);
  EXPECT_GT(sags[0], 0.1);
}

// A corner of one particle is a point load on a sheet. Its compliance grows with the logarithm of the resolution for any
// discretisation: by weight / 2 / (pi modulus) per factor of e, here 0.5 %. Measured: 2.4 % at rest.
TEST(Materials, AClothPinnedAtTwoCornersSagsAlikeAtAnyResolution) {
  std::vector<double> sags;
  for (const Index side : {16, 32, 64, 128}) sags.push_back(sag(level_cloth(side, true, 60.0), 2.0, 6.0));
  EXPECT_LT(spread(sags), 0.03);
  EXPECT_GT(sags[0], 1.0);
}

// The parabola w = (3 q L^4 / 64 EA)^(1/3) applies to shallow sags. The discrete arc sags by a fraction 1 / (n - 1)^2 less.
TEST(Materials, ARopeSagsAlikeAtAnyResolution) {
  std::vector<double> sags;
  for (const Index particles : {9, 17, 65, 257}) sags.push_back(sag(level_rope(particles, modulus(200.0), true), 1.5, 20.0));
  EXPECT_LT(spread(sags), 0.03);
  const double shallow = std::cbrt(3.0 * kDensity * testing::kGravity / (64.0 * 200.0));
  EXPECT_NEAR(sags.back(), shallow, 0.03 * shallow);
}

TEST(Materials, SagDoesNotDependOnTheStep) {
  const SpringNetwork cloth = level_cloth(32, false, 20.0);
  EXPECT_LT(spread({sag(cloth, 1.0, 17.0, 0.9), sag(cloth, 1.0, 17.0, 0.225)}), 0.01);
  const SpringNetwork rope = level_rope(33, modulus(200.0), true);
  EXPECT_LT(spread({sag(rope, 1.5, 20.0, 0.9), sag(rope, 1.5, 20.0, 0.225)}), 0.01);
}

/// The energy of the slowest longitudinal mode of a rope with one fixed end after `seconds`, divided by its initial energy.
double energy_left(Index particles, double damping_ratio, double seconds) {
  SpringNetwork rope = level_rope(particles, modulus(200.0, damping_ratio), false);
  for (Index i = 0; i < particles; ++i) {
    rope.velocities(0, i) = 1.0e-3 * std::sin(std::numbers::pi / 2.0 * rope.positions(0, i));
  }
  SimulatorSettings settings{.gravity = Vector3::Zero(), .integrator = SymplecticEulerSettings{}};
  settings.step = 0.1 * largest_stable_step(settings.integrator, simulation_bounds(rope, settings, false));
  Simulator simulator(rope, settings);
  const auto energy = [&] {
    return simulator.elastic_energy() + 0.5 * rope.masses.dot(simulator.state().v.colwise().squaredNorm().transpose());
  };
  const double start = energy();
  run(simulator, seconds);
  return energy() / start;
}

// Frequencies, with c^2 = EA / density: pi / 2 c / L for the mode, sqrt(3) c / L for the spring's own breathing mode. The mode's
// damping ratio zeta' is zeta times their quotient. The energy decays as exp(-2 zeta' omega' t) on average and oscillates by 2
// zeta' around it.
TEST(Materials, ADampingRatioSlowsARopeAlikeAtAnyResolution) {
  const double ratio = 0.05;
  const double speed = std::sqrt(200.0 / kDensity);
  const double own_frequency = std::numbers::pi / 2.0 * speed;
  const double own_ratio = ratio * own_frequency / (std::sqrt(3.0) * speed);
  const double period = 2.0 * std::numbers::pi / own_frequency;
  for (const Index particles : {9, 17, 33, 65}) {
    const double left = energy_left(particles, ratio, 4.0 * period);
    EXPECT_NEAR(std::log(left), -2.0 * own_ratio * own_frequency * 4.0 * period, 0.1) << particles << " particles";
  }
}

}  // namespace
}  // namespace sprung
