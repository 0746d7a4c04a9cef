#include "dynamics/forces/spring_force.h"

#include "base/parallel.h"
#include "dynamics/networks.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Points forces_at(const SpringNetwork& network, const Points& x, const Points& v) {
  Points forces = Points::Zero(3, network.particle_count());
  SpringForce(network).add({.x = x, .v = v}, forces);
  return forces;
}

/// Eq. 5-12 spring by spring, with the sign of the manual's code.
Points forces_by_the_manual(const SpringNetwork& network, const Points& x, const Points& v) {
  Points forces = Points::Zero(3, network.particle_count());
  const Springs& springs = network.springs;
  for (Index k = 0; k < springs.count(); ++k) {
    const Index p1 = springs.first[k];
    const Index p2 = springs.second[k];
    const Vector3 s = x.col(p1) - x.col(p2);
    if (s.norm() == 0.0) continue;
    const Vector3 e = s.normalized();
    const double v1e = e.dot(v.col(p1));
    const double v2e = e.dot(v.col(p2));
    const Vector3 force = (-springs.stiffness[k] * (s.norm() - springs.rest_length[k]) - springs.damping[k] * (v1e - v2e)) * e;
    forces.col(p1) += force;
    forces.col(p2) -= force;
  }
  return forces;
}

/// The sum of the magnitudes of all terms over springs, for tolerances.
double force_scale(const SpringNetwork& network, const Points& x, const Points& v) {
  const Springs& springs = network.springs;
  double scale = 0.0;
  for (Index k = 0; k < springs.count(); ++k) {
    const Index a = springs.first[k];
    const Index b = springs.second[k];
    scale += springs.stiffness[k] * ((x.col(a) - x.col(b)).norm() + springs.rest_length[k]);
    scale += springs.damping[k] * (v.col(a).norm() + v.col(b).norm());
  }
  return scale;
}

/// Bends and waves a flat network.
void disturb(SpringNetwork& network) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    network.positions.col(i) += 0.01 * Vector3(std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i));
    network.velocities.col(i) = Vector3(std::cos(0.3 * i), std::sin(0.7 * i), std::cos(1.1 * i));
  }
}

TEST(SpringForce, MatchesAHandComputedValue) {
  // s = p1 - p2 = (-3, -4, 0), |s| = 5, e = (-0.6, -0.8, 0), stretch 5 - 2 = 3; v1e - v2e = e . (1, 0, 0) = -0.6.
  // F = (-10 * 3 - 0.5 * (-0.6)) e = -29.7 e = (17.82, 23.76, 0).
  SpringNetwork network = make_pair(1.0, 10.0, 2.0, 0.5);
  network.positions.col(1) = Vector3(3.0, 4.0, 0.0);
  network.velocities.col(0) = Vector3(1.0, 0.0, 0.0);
  const Points forces = forces_at(network, network.positions, network.velocities);
  const double tolerance = 8 * kEpsilon * 29.7;  // a handful of roundings
  EXPECT_LT((forces.col(0) - Vector3(17.82, 23.76, 0.0)).norm(), tolerance);
  EXPECT_EQ(forces.col(1), -forces.col(0));
}

// Eq. 2-4, with particle 1 on the left: F1 = k (x2 - x1 - d) + c (v2 - v1), F2 = -F1.
TEST(SpringForce, IsTheOneDimensionalLawOnALine) {
  for (const double distance : {0.5, 1.5, 4.0}) {
    SpringNetwork network = make_pair(distance, 3.0, 1.5, 0.25);
    network.velocities.row(0) << 0.5, -1.0;
    const Points forces = forces_at(network, network.positions, network.velocities);
    const double expected = 3.0 * (distance - 1.5) + 0.25 * (-1.0 - 0.5);
    EXPECT_NEAR(forces(0, 0), expected, 16 * kEpsilon * 3.0 * distance);
    EXPECT_EQ(forces(0, 1), -forces(0, 0));
  }
}

// The printed elastic term, -k_s (d - |s|) along e, would push these ends apart.
TEST(SpringForce, StretchedSpringContracts) {
  const SpringNetwork network = make_pair(2.0, 1.0, 1.0);
  const Points forces = forces_at(network, network.positions, network.velocities);
  EXPECT_GT(forces(0, 0), 0.0);
  EXPECT_LT(forces(0, 1), 0.0);
}

TEST(SpringForce, CompressedSpringExpands) {
  const SpringNetwork network = make_pair(0.5, 1.0, 1.0);
  const Points forces = forces_at(network, network.positions, network.velocities);
  EXPECT_LT(forces(0, 0), 0.0);
  EXPECT_GT(forces(0, 1), 0.0);
}

TEST(SpringForce, VanishesAtRestLength) {
  const SpringNetwork network = make_pair(0.3, 1.0e6, 0.3);
  EXPECT_EQ(forces_at(network, network.positions, network.velocities), Points::Zero(3, 2));
}

TEST(SpringForce, DampingSlowsOnlyTheApproach) {
  SpringNetwork network = make_pair(1.0, 0.0, 1.0, 2.0);
  network.velocities.col(1) = Vector3(0.0, 5.0, 0.0);
  EXPECT_EQ(forces_at(network, network.positions, network.velocities), Points::Zero(3, 2)) << "sideways";
  network.velocities.col(1) = Vector3(3.0, 5.0, 0.0);
  EXPECT_EQ(forces_at(network, network.positions, network.velocities).col(0), Vector3(6.0, 0.0, 0.0)) << "apart";
}

TEST(SpringForce, ASpringWithoutLengthGivesNoForce) {
  SpringNetwork network = make_pair(1.0, 10.0, 1.0, 1.0);
  network.positions.col(1) = network.positions.col(0);
  network.velocities.col(1) = Vector3(1.0, 2.0, 3.0);
  EXPECT_EQ(forces_at(network, network.positions, network.velocities), Points::Zero(3, 2));
  // Runs too: all particles of a cloth lie in one point.
  SpringNetwork cloth = make_test_cloth(12, 100.0, 1.0);
  cloth.positions.setConstant(0.25);
  EXPECT_EQ(forces_at(cloth, cloth.positions, cloth.velocities), Points::Zero(3, 144));
}

/// Some of the springs, so that there are runs of both laws and single springs of both.
void let_some_only_pull(SpringNetwork& network) {
  network.springs.laws.resize(static_cast<std::size_t>(network.springs.count()));
  for (Index s = 0; s < network.springs.count(); ++s) network.springs.laws[s].tension_only = s % 70 >= 30;
}

TEST(SpringForce, ATensionOnlySpringHasNoForceUnlessItIsLongerThanAtRest) {
  SpringNetwork network = make_pair(1.0, 10.0, 1.0, 0.5);
  network.springs.laws = {{.tension_only = true}};
  network.velocities.col(1) = Vector3(-3.0, 0.0, 0.0);
  for (const double distance : {0.0, 0.5, 1.0}) {
    network.positions(0, 1) = distance;
    EXPECT_EQ(forces_at(network, network.positions, network.velocities), Points::Zero(3, 2)) << distance;
    EXPECT_EQ(SpringForce(network).energy(network.positions), 0.0);
  }
  network.positions(0, 1) = 1.5;
  const Points forces = forces_at(network, network.positions, network.velocities);
  network.springs.laws.clear();
  EXPECT_EQ(forces, forces_at(network, network.positions, network.velocities)) << "stretched it is like any other";
  EXPECT_NE(forces(0, 0), 0.0);
}

TEST(SpringForce, TensionOnlySpringsAmongOthersActAsTheManualsWhileTheyAreStretched) {
  for (SpringNetwork network : {make_test_cloth(40, 100.0, 1.0), make_random_network(300, 600)}) {
    disturb(network);
    let_some_only_pull(network);
    SpringNetwork taut = network;  // the springs that have a force
    Springs& springs = taut.springs;
    Index slack = 0;
    for (Index s = 0; s < springs.count(); ++s) {
      const double length = (network.positions.col(springs.first[s]) - network.positions.col(springs.second[s])).norm();
      if (!springs.laws[s].tension_only || length > springs.rest_length[s]) continue;
      springs.stiffness[s] = springs.damping[s] = 0.0;
      ++slack;
    }
    EXPECT_GT(slack, springs.count() / 10);
    const Points forces = forces_at(network, network.positions, network.velocities);
    const Points expected = forces_by_the_manual(taut, network.positions, network.velocities);
    // Each force is rounded a dozen times.
    EXPECT_LT((forces - expected).cwiseAbs().maxCoeff(),
              16 * kEpsilon * force_scale(network, network.positions, network.velocities));
    EXPECT_NEAR(SpringForce(network).energy(network.positions), SpringForce(taut).energy(network.positions),
                1e3 * kEpsilon * SpringForce(taut).energy(network.positions));
  }
}

TEST(SpringForce, FollowsRestLengthsThatChangeLater) {
  SpringNetwork network = make_test_cloth(40, 100.0, 1.0);
  disturb(network);
  network.springs.laws.assign(static_cast<std::size_t>(network.springs.count()), {.yield = 0.1});
  const SpringForce force(network);
  for (Index s = 0; s < network.springs.count(); ++s) network.springs.rest_length[s] *= 1.0 + 1e-3 * (s % 7);
  Points forces = Points::Zero(3, network.particle_count());
  force.add({.x = network.positions, .v = network.velocities}, forces);
  EXPECT_EQ(forces, forces_at(network, network.positions, network.velocities));
}

TEST(SpringForce, IsTheNegativeGradientOfItsEnergy) {
  SpringNetwork network = make_test_cloth(10, 100.0, 0.0);
  disturb(network);
  const SpringForce force(network);
  const Points forces = forces_at(network, network.positions, network.velocities);
  // Central differences: error h^2 / 6 times the third derivative, about k / d^2 * d = 100 / 0.1 / 0.1, plus epsilon E / h.
  const double h = 1.0e-6;
  const double tolerance = h * h * 1.0e5 + kEpsilon * force.energy(network.positions) / h;
  for (const Index particle : {0, 37, 55, 99}) {
    for (int axis = 0; axis < 3; ++axis) {
      Points x = network.positions;
      x(axis, particle) += h;
      const double above = force.energy(x);
      x(axis, particle) -= 2.0 * h;
      const double below = force.energy(x);
      EXPECT_NEAR(forces(axis, particle), -(above - below) / (2.0 * h), tolerance) << "particle " << particle;
    }
  }
}

TEST(SpringForce, HasNoNetForceAndNoNetTorque) {
  SpringNetwork cloth = make_test_cloth(100, 400.0, 0.1);
  disturb(cloth);
  for (const SpringNetwork& network : {cloth, make_random_network(300, 2000)}) {
    const Points forces = forces_at(network, network.positions, network.velocities);
    Vector3 force = Vector3::Zero();
    Vector3 torque = Vector3::Zero();
    for (Index i = 0; i < network.particle_count(); ++i) {
      force += forces.col(i);
      torque += network.positions.col(i).cross(forces.col(i));
    }
    // Each force is rounded a few times, relative to its terms; lever arms are at most 2 m.
    const double tolerance = 8 * kEpsilon * force_scale(network, network.positions, network.velocities);
    EXPECT_LT(force.norm(), tolerance);
    EXPECT_LT(torque.norm(), 2.0 * tolerance);
  }
}

TEST(SpringForce, RunsAndSingleSpringsFollowTheManual) {
  std::vector<SpringNetwork> networks;
  // Widths near the kernel's SIMD width and batch size, and networks of several blocks.
  for (const Index side : {2, 3, 9, 65, 66, 69, 130}) networks.push_back(make_test_cloth(side, 400.0, 0.1));
  for (SpringNetwork& network : networks) disturb(network);
  networks.push_back(make_random_network(3000, 20000));
  for (const SpringNetwork& network : networks) {
    const Points forces = forces_at(network, network.positions, network.velocities);
    const Points expected = forces_by_the_manual(network, network.positions, network.velocities);
    // A particle has some 12 (cloth) to 30 springs, each rounded a few times relative to k d.
    const double per_spring = force_scale(network, network.positions, network.velocities) / network.springs.count();
    EXPECT_LT((forces - expected).cwiseAbs().maxCoeff(), 200 * kEpsilon * per_spring) << network.particle_count();
  }
}

TEST(SpringForce, SpringsWithoutStiffnessAndDampingGiveNoForce) {
  SpringNetwork network = make_test_cloth(40, 400.0, 0.1);
  disturb(network);
  for (Index k = 0; k < network.springs.count(); ++k) {
    if (k % 37 < 9) network.springs.stiffness[k] = 0.0;
    if (k % 41 < 15) network.springs.damping[k] = 0.0;
  }
  const Points forces = forces_at(network, network.positions, network.velocities);
  const Points expected = forces_by_the_manual(network, network.positions, network.velocities);
  const double per_spring = force_scale(network, network.positions, network.velocities) / network.springs.count();
  EXPECT_LT((forces - expected).cwiseAbs().maxCoeff(), 200 * kEpsilon * per_spring);
}

TEST(SpringForce, EachSpringOfARunUsesItsOwnConstants) {
  SpringNetwork network = make_test_cloth(40, 400.0, 0.1);
  disturb(network);
  for (Index k = 0; k < network.springs.count(); ++k) {
    network.springs.stiffness[k] *= 1.0 + 0.1 * (k % 7);
    network.springs.rest_length[k] *= 1.0 + 0.1 * (k % 5);
    network.springs.damping[k] *= 1.0 + 0.1 * (k % 3);
  }
  const Points forces = forces_at(network, network.positions, network.velocities);
  const Points expected = forces_by_the_manual(network, network.positions, network.velocities);
  const double per_spring = force_scale(network, network.positions, network.velocities) / network.springs.count();
  EXPECT_LT((forces - expected).cwiseAbs().maxCoeff(), 200 * kEpsilon * per_spring);
}

TEST(SpringForce, HasTheSameBitsForAnyNumberOfThreads) {
  SpringNetwork cloth = make_test_cloth(130, 400.0, 0.1);
  disturb(cloth);
  for (const SpringNetwork& network : {cloth, make_random_network(5000, 30000)}) {
    Points alone;
    {
      const ThreadLimit limit(1);
      alone = forces_at(network, network.positions, network.velocities);
    }
    for (int repeat = 0; repeat < 5; ++repeat) {
      const ThreadLimit limit(2 + repeat);
      EXPECT_EQ(forces_at(network, network.positions, network.velocities), alone);
    }
  }
}

TEST(SpringForce, AcceptsNetworksWithoutSprings) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(forces_at(network, network.positions, network.velocities), Points::Zero(3, 1));
  EXPECT_EQ(SpringForce(network).energy(network.positions), 0.0);
}

}  // namespace
}  // namespace sprung
