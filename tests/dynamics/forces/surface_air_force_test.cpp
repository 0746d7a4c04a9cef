#include "dynamics/forces/surface_air_force.h"

#include "base/parallel.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "dynamics/networks.h"
#include "network/model/spring_failure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

/// The cloth of 1 m in the x-y plane moves at this velocity [m/s].
SpringNetwork moving_cloth(Index side, const Vector3& velocity) {
  SpringNetwork network = make_test_cloth(side, 10.0, 0.0, false);
  network.velocities.colwise() = velocity;
  return network;
}

/// With implicit steps, at time 0.
Vector3 total_force(const SpringNetwork& network, const SurfaceDrag& drag, const Wind& wind, double step = 0.0) {
  Points forces = Points::Zero(3, network.particle_count());
  SurfaceAirForce(network, drag, wind, 0.0, step).add({.x = network.positions, .v = network.velocities}, forces);
  return forces.rowwise().sum();
}

// A = 1 m^2 in the x-y plane, u = (3, 4, -2) m/s.
TEST(SurfaceAirForce, IsTheSumOverFacesAtAnyResolution) {
  for (const Index side : {2, 5, 17}) {
    const SpringNetwork network = moving_cloth(side, Vector3(-1, 0, 2));
    const Wind wind(Vector3(2, 4, 0));
    const Vector3 linear = total_force(network, {.normal = 0.5, .tangential = 0.1}, wind);
    EXPECT_LT((linear - Vector3(0.1 * 3, 0.1 * 4, 0.5 * -2)).norm(), 1e-13) << side;
    const Vector3 quadratic = total_force(network, {.normal = 0.5, .tangential = 0.1, .quadratic = true}, wind);
    EXPECT_LT((quadratic - Vector3(0.1 * 5 * 3, 0.1 * 5 * 4, 0.5 * 2 * -2)).norm(), 1e-12) << side;
  }
}

TEST(SurfaceAirForce, FollowsTheFacesAsTheyTurnAndGrow) {
  SpringNetwork network = moving_cloth(4, Vector3::Zero());
  const SurfaceAirForce force(network, {.normal = 0.5}, Vector3(2, 0, 0), 0.0, 0.0);
  // Twice as large, and at 45 degrees to the wind: F = A n (n . u) with 4 m^2.
  const Points turned = 2.0 * (Eigen::AngleAxisd(0.25 * std::numbers::pi, Vector3::UnitY()).toRotationMatrix() * network.positions);
  Points forces = Points::Zero(3, network.particle_count());
  force.add({.x = turned, .v = network.velocities}, forces);
  EXPECT_LT((forces.rowwise().sum() - 4.0 * 0.5 * Vector3(1, 0, 1)).norm(), 1e-12);
}

TEST(SurfaceAirForce, OfACollapsedFaceIsZero) {
  const SpringNetwork network = moving_cloth(3, Vector3(1, 2, 3));
  const SurfaceAirForce force(network, {.normal = 0.5, .tangential = 0.1}, Vector3(2, 0, 0), 0.0, 0.0);
  const Points collapsed = Points::Zero(3, network.particle_count());
  Points forces = Points::Zero(3, network.particle_count());
  force.add({.x = collapsed, .v = network.velocities}, forces);
  EXPECT_TRUE(forces.isZero(0.0));
}

/// The largest damping rate [1/s] that the force hands to the step's bound.
double bound_of(const SurfaceAirForce& force, const SpringNetwork& network) {
  std::vector<LinearElement> elements;
  force.append_elements(elements);
  return spectral_bounds(elements, network.inverse_masses).damping;
}

// The cloth of 0.2 kg/m^2 reaches sqrt(0.2 g / 0.5) = 1.98 m/s as it falls; gusts of 1 m/s add 2 m/s. All of the cloth moving at
// once is the mode that is damped most. The bound's margin is up to 1.5 %.
TEST(SurfaceAirForce, CountsItsRateAtTheExpectedSpeed) {
  SpringNetwork network = moving_cloth(9, Vector3::Zero());
  network.masses = 0.2 * network.drag_areas;
  network.inverse_masses = network.masses.cwiseInverse();
  const Wind wind({{0.0, Vector3(3, 0, 0)}, {1.0, Vector3(0, 4, 0)}}, Gusts{.speed = 1.0});
  const double speed = std::sqrt(0.2 * 9.81 / 0.5) + 4.0 + 2.0;
  const SurfaceAirForce quadratic(network, {.normal = 0.5, .tangential = 0.2, .quadratic = true}, wind, 9.81, 1e-3);
  const double rate = bound_of(quadratic, network) / (2.0 * 0.5 * speed / 0.2);
  EXPECT_GE(rate, 1.0 - 1e-12);
  EXPECT_LE(rate, 1.0151);
  const SurfaceAirForce linear(network, {.normal = 0.2, .tangential = 0.5}, wind, 9.81, 1e-3);
  EXPECT_GE(bound_of(linear, network) / (0.5 / 0.2), 1.0 - 1e-12);
  EXPECT_LE(bound_of(linear, network) / (0.5 / 0.2), 1.0151);
  EXPECT_NEAR(linear.largest_acceleration(), 0.5 / 0.2 * wind.max_speed(), 1e-12 * linear.largest_acceleration());
}

// The step was chosen for the whole cloth. All of its faces have the same area.
TEST(SurfaceAirForce, FacesThatAreLeftOfATornClothBoundTheStepAsBefore) {
  SpringNetwork network = moving_cloth(5, Vector3::Zero());
  const auto elements_of = [&] {
    std::vector<LinearElement> elements;
    SurfaceAirForce(network, {.normal = 0.5, .quadratic = true}, Wind(), 9.81, 1e-3).append_elements(elements);
    return elements;
  };
  const std::vector<LinearElement> whole = elements_of();
  std::vector<Index> structural;
  for (Index s = 0; s < network.springs.count(); ++s) {
    if (network.springs.kind[s] == SpringKind::structural && network.springs.second[s] > 10) structural.push_back(s);
  }
  tear(network, with_dependents(network.springs, structural));
  const std::vector<LinearElement> torn = elements_of();
  EXPECT_LT(torn.size(), whole.size());
  ASSERT_FALSE(torn.empty());
  for (const LinearElement& element : torn) EXPECT_NEAR(element.damping, whole[0].damping, 1e-12 * whole[0].damping);
}

// Whatever its speed, a step takes at most a quarter of the velocity, as the derivative is at most 1 / (4 dt). Without that bound
// it would take more than 100 times the velocity at 2,000 m/s. The rate of the cloth at 1 m/s, 2 * 1 m/s * 1 kg/m^3 * 1/25 m^2 by a
// mass of 0.2/36 kg, is 14 1/s, below 1 / (4 dt) = 25 1/s.
TEST(SurfaceAirForce, NeverReversesTheMotionInAStep) {
  const double dt = 0.01;
  const SurfaceDrag drag{.normal = 1.0, .tangential = 0.3, .quadratic = true};
  for (const double speed : {1e-3, 1.0, 5.0, 20.0, 2e3, 1e9}) {
    const SpringNetwork network = moving_cloth(6, speed * Vector3(0.48, 0.6, 0.64));
    const SurfaceAirForce force(network, drag, Wind(), 0.0, dt);
    Points forces = Points::Zero(3, network.particle_count());
    force.add({.x = network.positions, .v = network.velocities}, forces);
    for (Index i = 0; i < network.particle_count(); ++i) {
      const Vector3 change = dt * network.inverse_masses[i] * forces.col(i);
      const Vector3 velocity = network.velocities.col(i);
      EXPECT_LE(change.norm(), 0.25 * velocity.norm() * (1.0 + 1e-12)) << speed;
      EXPECT_LT(change.dot(velocity), 0.0) << speed;
    }
    const double share = -total_force(network, drag, Wind(), dt).dot(Vector3(0.48, 0.6, 0.64)) /
                         -total_force(network, drag, Wind()).dot(Vector3(0.48, 0.6, 0.64));
    EXPECT_EQ(std::abs(share - 1.0) < 1e-12, speed <= 1.0) << "quadratic where the step resolves it: " << speed;
  }
}

TEST(SurfaceAirForce, HasTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork network = moving_cloth(60, Vector3(1, 2, 3));
  const Wind wind({{0.0, Vector3(3, 0, 0)}}, Gusts{.speed = 2.0, .length = 0.3, .seed = 4});
  const SurfaceAirForce force(network, {.normal = 1.0, .tangential = 0.1, .quadratic = true}, wind, 9.81, 1e-3);
  const auto forces = [&](int threads) {
    const ThreadLimit limit(threads);
    Points sum = Points::Zero(3, network.particle_count());
    force.add({.x = network.positions, .v = network.velocities, .time = 0.4}, sum);
    return sum;
  };
  const Points alone = forces(1);
  EXPECT_EQ(forces(2), alone);
  EXPECT_EQ(forces(4), alone);
}

}  // namespace
}  // namespace sprung
