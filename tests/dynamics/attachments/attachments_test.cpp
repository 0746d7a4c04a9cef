// Laws of one pass over rods, and of the derivatives of the springs of attachments.
#include "dynamics/attachments/attachments.h"

#include "base/test_seed.h"
#include "dynamics/constraints/same_bits.h"
#include "dynamics/dense_matrix.h"
#include "dynamics/forces/force_derivatives.h"
#include "network/network_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace sprung {
namespace {

class RandomLinks : public test::SeededTest {
 protected:
  Vector3 random_vector() {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    return {unit(random_), unit(random_), unit(random_)};
  }

  /// Two bodies of `count` particles each, more than a metre apart, the second with triangles of three neighbours.
  NetworkBuilder bodies(Index count) {
    NetworkBuilder builder;
    for (const double x : {0.0, 3.0}) {
      BodyShape shape;
      for (Index i = 0; i < count; ++i) {
        shape.positions.emplace_back(random_vector() + Vector3(x, 0.0, 0.0));
        shape.velocities.emplace_back(random_vector());
        shape.masses.push_back(0.1 + std::abs(random_vector().x()));
        shape.drag_areas.push_back(0.0);
      }
      shape.surface.triangles.resize(3, count - 2);
      for (Index t = 0; t < count - 2; ++t) shape.surface.triangles.col(t) << t, t + 1, t + 2;
      builder.add_body(x == 0.0 ? "first" : "second", shape, {}, {.self = false, .others = false});
    }
    return builder;
  }

  static std::vector<Index> first_particles(Index count) {
    std::vector<Index> particles;
    for (Index i = 0; i < count; ++i) particles.push_back(i);
    return particles;
  }

 private:
  std::mt19937 random_{static_cast<std::uint32_t>(test::seeded(1))};
};

/// The links of a network's attachments, all engaged.
SimulationState engaged(const SpringNetwork& network, Attachments& attachments) {
  SimulationState state = initial_state(network);
  EXPECT_TRUE(attachments.update(state));
  EXPECT_FALSE(attachments.update(state)) << "they engage once";
  return state;
}

TEST_F(RandomLinks, APassMovesNoCentreOfMassAndGivesTheSameBitsForAnyNumberOfThreads) {
  const Index count = 600;
  NetworkBuilder builder = bodies(count);
  builder.add_attachment({.name = "rods", .particles = first_particles(count), .second = SurfaceEnd{1}});
  const SpringNetwork network = builder.build();
  const ObstacleSet obstacles;
  Attachments attachments(network, obstacles, 1e-3, false);
  const SimulationState state = engaged(network, attachments);
  ASSERT_EQ(state.links.size(), static_cast<std::size_t>(count));
  const Points start = state.x + 0.01 * network.velocities;
  testing::expect_same_bits(*attachments.rods(), start);
  Points after = start;
  EXPECT_GT(attachments.rods()->project(state.x, after, {}), 1.0);
  // A thousand particles of 1 kg that move by up to 1 cm, each rounded to 1e-16 m.
  EXPECT_LE(((after - start) * network.masses).norm(), 1e-12);
  // The displacements are along the lines between the ends before, so that they have no moment.
  Vector3 moment = Vector3::Zero();
  for (Index i = 0; i < network.particle_count(); ++i)
    moment += network.masses[i] * state.x.col(i).cross(after.col(i) - start.col(i));
  EXPECT_LE(moment.norm(), 1e-12);
}

TEST_F(RandomLinks, OnePassRestoresARodOnItsOwn) {
  for (int trial = 0; trial < 50; ++trial) {
    NetworkBuilder builder = bodies(3);
    builder.add_attachment({.name = "rod", .particles = {0}, .second = SurfaceEnd{1}});
    const SpringNetwork network = builder.build();
    const ObstacleSet obstacles;
    Attachments attachments(network, obstacles, 1e-3, false);
    const SimulationState state = engaged(network, attachments);
    // Up to a half turn and more: then it moves along the present line between the ends.
    Points after = state.x + 0.1 * (1 + trial % 30) * network.velocities;
    (void)attachments.rods()->project(state.x, after, {});
    EXPECT_LE(attachments.rods()->residual(after), 1e-9) << trial;
  }
}

// Central differences over 2 h are off by h^2 / 6 of the third derivative and by the rounding 1e-16 F / h: for h = 1e-5, and forces
// and derivatives of up to 1e3, by less than 1e-6. Springs here are taut, where no derivative is left out.
TEST_F(RandomLinks, DerivativesOfSpringsAreThoseOfTheirForces) {
  constexpr double kStep = 1.0e-5;
  NetworkBuilder builder = bodies(3);
  builder.add_attachment({.name = "taut", .particles = {0}, .second = SurfaceEnd{1}, .stiffness = 70.0, .rest_length = 0.01});
  builder.add_attachment(
      {.name = "point", .particles = {1}, .second = ParticleEnds{{4}}, .stiffness = 30.0, .damping = 5.0, .rest_length = 0.0});
  const SpringNetwork network = builder.build();
  const ObstacleSet obstacles;
  Attachments attachments(network, obstacles, 1e-3, false);
  const SimulationState state = engaged(network, attachments);
  const Points& x = state.x;
  const Points v = Points::Zero(3, x.cols());  // a damper's force depends on positions too, but for particles at rest
  const auto force = [&](const Points& positions, const Points& velocities) {
    Points total = Points::Zero(3, x.cols());
    attachments.springs()->add({.x = positions, .v = velocities, .time = 0.0}, total);
    return Eigen::VectorXd(total.reshaped());
  };
  Forces forces;
  std::vector<ParticlePair> pairs;
  attachments.springs()->couple(pairs);
  ForceDerivatives derivatives = make_derivatives(forces, network.particle_count(), pairs);
  attachments.springs()->add_derivatives({.x = x, .v = v, .time = 0.0}, derivatives);
  const Eigen::MatrixXd by_position = dense(derivatives.by_position);
  const Eigen::MatrixXd by_velocity = dense(derivatives.by_velocity);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Points moved = Points::Zero(3, x.cols());
    moved(k) = kStep;
    EXPECT_LE((by_position.col(k) - (force(x + moved, v) - force(x - moved, v)) / (2.0 * kStep)).norm(), 1e-6) << k;
    EXPECT_LE((by_velocity.col(k) - (force(x, moved) - force(x, -moved)) / (2.0 * kStep)).norm(), 1e-6) << k;
  }
}

}  // namespace
}  // namespace sprung
