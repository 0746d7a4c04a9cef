#include "dynamics/integrators/implicit_system.h"

#include "dynamics/forces/force_derivatives.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/networks.h"

#include <gmock/gmock.h>

#include <limits>
#include <memory>

namespace sprung {
namespace {

// Substitutes the solution into the equations, block by block, without the pins.
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
  ImplicitSystem system(network, derivatives);
  system.assemble(derivatives, dt);
  system.solve(y);
  Points left = y * network.masses.asDiagonal();
  derivatives.by_velocity.add_product(y, -dt, left);
  derivatives.by_position.add_product(y, -dt * dt, left);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_fixed(i)) {
      EXPECT_EQ(y.col(i), Vector3::Zero());
    } else {
      // The matrix has a condition number of some hundreds.
      EXPECT_LT((left.col(i) - right.col(i)).norm(), 1.0e-12);
    }
  }
}

// Two masses on a spring. The first is constrained along x, so the other is pulled back by h^2 k of its displacement. Both are
// free across.
TEST(ImplicitSystem, ConstrainsAParticleAlongADirection) {
  const SpringNetwork network = make_pair(1.0, 10.0, 1.0);
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(network));
  ForceDerivatives derivatives = make_derivatives(forces, 2);
  differentiate(forces, {.x = network.positions, .v = network.velocities, .time = 0.0}, derivatives);
  ImplicitSystem system(network, derivatives);
  system.assemble(derivatives, 0.5);
  Points y = Points::Zero(3, 2);
  y.col(0) = Vector3(5.0, 3.0, 0.0);
  y.col(1) = Vector3(7.0, 0.0, 0.0);
  system.constrain(0, Vector3::UnitX() * Vector3::UnitX().transpose());
  system.constrain(1, Matrix3::Zero());
  system.solve(y);
  // A constraint weighs a million times as much as the particle's equations.
  EXPECT_LT((y.col(0) - Vector3(0.0, 3.0, 0.0)).norm(), 1.0e-5);
  EXPECT_LT((y.col(1) - Vector3(7.0 / (1.0 + 2.5), 0.0, 0.0)).norm(), 1.0e-5);
}

TEST(ImplicitSystem, AcceptsFullyPinnedNetworks) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.pin(0);
  const SpringNetwork network = builder.build();
  const ForceDerivatives derivatives = make_derivatives({}, 1);
  Points vectors = Points::Ones(3, 1);
  ImplicitSystem system(network, derivatives);
  system.assemble(derivatives, 0.1);
  system.solve(vectors);
  EXPECT_TRUE(vectors.isZero(0.0));
}

TEST(ImplicitSystem, ReturnsNaNWithoutASolution) {
  const SpringNetwork network = make_pair(1.0, 10.0, 1.0);
  Forces forces;
  forces.push_back(std::make_unique<SpringForce>(network));
  ForceDerivatives derivatives = make_derivatives(forces, 2);
  ImplicitSystem system(network, derivatives);
  derivatives.by_position.add(0, 0, Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()));
  Points vectors = Points::Ones(3, 2);
  system.assemble(derivatives, 0.1);
  system.solve(vectors);
  EXPECT_FALSE(vectors.allFinite());
}

}  // namespace
}  // namespace sprung
