#include "dynamics/implicit_system.h"

#include "dynamics/body_forces.h"
#include "dynamics/networks.h"
#include "dynamics/spring_force.h"

#include <gmock/gmock.h>

#include <limits>
#include <memory>

namespace sprung {
namespace {

// What is solved for is put back into the equations, block by block; pins are no part of them.
TEST(ImplicitSystem, SolutionFulfilsTheEquationsOfFreeParticles) {
  SpringNetwork network = make_test_cloth(7, 300.0, 0.5);
  network.positions.row(2) = 0.1 * network.positions.row(0).array().sin();
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(network));
  forces.push_back(std::make_unique<AirDrag>(network, 0.4, Vector3::Zero()));
  ForceDerivatives derivatives = make_derivatives(forces, network.particle_count());
  differentiate(forces, {.x = network.positions, .v = network.velocities, .time = 0.0}, derivatives);
  const double dt = 0.02;
  const Points right = Points::Random(3, network.particle_count());
  Points y = right;
  ImplicitSystem(network, derivatives).solve(derivatives, dt, y);
  Points left = y * network.masses.asDiagonal();
  derivatives.by_velocity.add_product(y, -dt, left);
  derivatives.by_position.add_product(y, -dt * dt, left);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_pinned(i)) {
      EXPECT_EQ(y.col(i), Vector3::Zero());
    } else {
      // The matrix has a condition number of some hundreds.
      EXPECT_LT((left.col(i) - right.col(i)).norm(), 1.0e-12);
    }
  }
}

TEST(ImplicitSystem, TakesNetworksThatArePinnedAltogether) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.pin(0);
  const SpringNetwork network = builder.build();
  const ForceDerivatives derivatives = make_derivatives({}, 1);
  Points vectors = Points::Ones(3, 1);
  ImplicitSystem(network, derivatives).solve(derivatives, 0.1, vectors);
  EXPECT_TRUE(vectors.isZero(0.0));
}

TEST(ImplicitSystem, TellsByNaNWhatHasNoSolution) {
  const SpringNetwork network = make_pair(1.0, 10.0, 1.0);
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(network));
  ForceDerivatives derivatives = make_derivatives(forces, 2);
  ImplicitSystem system(network, derivatives);
  derivatives.by_position.add(0, 0, Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()));
  Points vectors = Points::Ones(3, 2);
  system.solve(derivatives, 0.1, vectors);
  EXPECT_FALSE(vectors.allFinite());
}

}  // namespace
}  // namespace sprung
