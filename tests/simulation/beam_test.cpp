// Ropes and cloths with angle bends against the closed forms of beams, plates and chains.
#include "simulation/scenes.h"
#include "simulation/simulator.h"
#include "simulation/step/step_check.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

using testing::kGravity;

SpringMaterial modulus(double value) { return {.value = value, .measure = SpringMaterial::Measure::modulus}; }

/// The distance [m] of the lowest particle of a clamped body below y = 0, at rest under gravity.
double deflection(const BodyShape& shape, const std::vector<Index>& pins, double damping_rate, double seconds) {
  NetworkBuilder builder;
  builder.add_body("beam", shape);
  builder.pin(pins);
  SimulatorSettings settings{.integrator = VerletSettings{.damping_rate = damping_rate}};
  const SpringNetwork network = builder.build();
  settings.step = advised_step(settings.integrator, simulation_bounds(network, settings, false));
  Simulator simulator(network, settings);
  testing::run(simulator, seconds);
  return -simulator.positions().row(1).minCoeff();
}

// The beam is clamped half-way between the two pinned particles. Its slowest mode has omega = 3.52 sqrt(EI / density) / L^2 = 39
// 1/s: after 0.5 s of critical damping e^-19 of the amplitude remains. A deflection of 1 % of the length changes lengths by 1e-4.
TEST(AngleBends, ACantileveredRopeDeflectsAsABeam) {
  const double density = 0.1;
  const double bending = density * kGravity / (8.0 * 0.01);  // EI [N m^2] for a deflection of 1 cm at 1 m
  for (const Index particles : {11, 21, 41}) {
    BodyShape rope = make_rope(
        {.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = particles, .length = {}},
        {.structural = modulus(1e4 * bending), .bend = modulus(bending), .bend_model = SpringMaterials::BendModel::angle});
    set_density(rope, density);
    const double length = 1.0 - 0.5 / (particles - 1.0);
    const double expected = density * kGravity * std::pow(length, 4) / (8.0 * bending);
    EXPECT_NEAR(deflection(rope, {0, 1}, 78.0, 0.5), expected, 0.02 * expected) << particles << " particles";
  }
}

// A strip of cloth bends like a beam of D times its width, because its two directions are not coupled.
TEST(AngleBends, AStripOfClothDeflectsAsAPlate) {
  const double density = 0.1;
  const double bending = density * kGravity / (8.0 * 0.01);  // D [N m]
  for (const Index across : {2, 5}) {
    const Index along = 21;
    BodyShape cloth =
        make_cloth({.size = {1.0, 0.2}, .resolution = {along, across}}, {.structural = modulus(1e4 * bending),
                                                                         .shear = modulus(1e3 * bending),
                                                                         .bend = modulus(bending),
                                                                         .bend_model = SpringMaterials::BendModel::angle});
    set_density(cloth, density);
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
    place(cloth, pose);
    std::vector<Index> pins;
    for (Index row = 0; row < across; ++row) pins.insert(pins.end(), {row * along, row * along + 1});
    const double length = 1.0 - 0.5 / (along - 1.0);
    const double expected = density * kGravity * std::pow(length, 4) / (8.0 * bending);
    EXPECT_NEAR(deflection(cloth, pins, 78.0, 0.5), expected, 0.02 * expected) << across << " rows";
  }
}

/// L_n(x), the n-th Laguerre polynomial.
double laguerre(int n, double x) {
  double before = 1.0;
  double now = n == 0 ? 1.0 : 1.0 - x;
  for (int k = 1; k < n; ++k) {
    const double next = ((2.0 * k + 1.0 - x) * now - k * before) / (k + 1.0);
    before = now;
    now = next;
  }
  return now;
}

/// The first zeros of L_n, by bisection between its changes of sign. The first three zeros are more than 0.3 / n apart.
std::vector<double> laguerre_zeros(int n, std::size_t count) {
  std::vector<double> zeros;
  const double stride = 0.1 / n;
  for (double x = 0.0; zeros.size() < count; x += stride) {
    double low = x;
    double high = x + stride;
    if (laguerre(n, low) * laguerre(n, high) > 0.0) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (laguerre(n, low) * laguerre(n, middle) > 0.0 ? low : high) = middle;
    }
    zeros.push_back(low);
  }
  return zeros;
}

/// A chain of 1 m and `links` links that hangs from its last particle. All other particles have equal masses. The chain starts
/// stretched by its weight: otherwise its tension would swing between zero and twice the weight and shake the chain sideways.
SpringNetwork hanging_chain(Index links) {
  const double stiffness = 2000.0;  // EA [N]
  BodyShape rope = make_rope({.points = {-Vector3::UnitY(), Vector3::Zero()}, .particles = links + 1, .length = {}},
                             {.structural = modulus(stiffness)});
  set_total_mass(rope, 0.1);
  for (Index i = links - 1; i >= 0; --i) {
    const double tension = (i + 1) * rope.masses[i] * kGravity;
    rope.positions[i].y() = rope.positions[i + 1].y() - (1.0 + tension / stiffness) / links;
  }
  NetworkBuilder builder;
  builder.add_body("chain", rope);
  builder.pin(links);
  return builder.build();
}

/// The frequency [rad/s] of the chain in the mode in which particle i has the amplitude L_i(lambda), lambda = l omega^2 / g. It is
/// measured over `periods` upward zero crossings of the lowest particle.
double swing_frequency(Index links, double lambda, int periods) {
  SpringNetwork chain = hanging_chain(links);
  for (Index i = 0; i < links; ++i) chain.velocities(0, i) = 1e-4 * laguerre(i, lambda);
  SimulatorSettings settings{.integrator = SymplecticEulerSettings{}};
  settings.step = 0.25 * largest_stable_step(settings.integrator, simulation_bounds(chain, settings, false));
  Simulator simulator(chain, settings);
  double before = 0.0;
  double end = 0.0;
  for (int seen = 0; seen < periods;) {
    simulator.step();
    const double now = simulator.positions()(0, 0);
    if (before < 0.0 && now >= 0.0) {
      end = simulator.time() - settings.step * now / (now - before);
      ++seen;
    }
    before = now;
  }
  return 2.0 * std::numbers::pi * periods / end;
}

// Amplitudes are 1e-5 of the length. Springs of 2000 N are 0.03 % longer than at rest under half of the weight, which lowers
// frequencies by half of that. The step is at most 1e-3 of a period.
TEST(HangingChain, SwingsAtTheZerosOfLaguerresPolynomial) {
  for (const Index links : {5, 20}) {
    for (const double lambda : laguerre_zeros(links, 3)) {
      const double expected = std::sqrt(lambda * links * kGravity / 1.0);
      EXPECT_NEAR(swing_frequency(links, lambda, 3), expected, 0.002 * expected) << links << " links";
    }
  }
}

// omega = j_0n / 2 sqrt(g / L) with the zeros of Bessel's J_0. The first zeros of L_n are (j / 2)^2 / (n + 1/2): the frequencies
// of a hundred links are 0.25 % lower.
TEST(HangingChain, SwingsAtBesselsZerosWhenItHasManyLinks) {
  const std::vector<double> shapes = laguerre_zeros(100, 3);
  const double zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911013};
  for (std::size_t mode = 0; mode < 3; ++mode) {
    const double expected = 0.5 * zeros[mode] * std::sqrt(kGravity);
    EXPECT_NEAR(swing_frequency(100, shapes[mode], 2), expected, 0.01 * expected) << "mode " << mode + 1;
  }
}

}  // namespace
}  // namespace sprung
