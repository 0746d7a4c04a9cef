#include "dynamics/forces/gravity_and_drag.h"

#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

Points forces_of(const Force& force, const SpringNetwork& network) {
  Points total = Points::Zero(3, network.particle_count());
  force.add({.x = network.positions, .v = network.velocities}, total);
  return total;
}

TEST(Gravity, IsMassTimesAcceleration) {
  const SpringNetwork network = make_random_network(20, 0);
  const Vector3 g(1.0, -9.81, 0.5);
  const Points forces = forces_of(Gravity(network, g), network);
  for (Index i = 0; i < 20; ++i) EXPECT_EQ(forces.col(i), network.masses[i] * g);
}

TEST(Gravity, EnergyFallsByTheWorkDone) {
  const SpringNetwork network = make_random_network(20, 0);
  const Gravity gravity(network, Vector3(0.0, -9.81, 0.0));
  Points lower = network.positions;
  lower.row(1).array() -= 0.5;
  const double work = network.masses.sum() * 9.81 * 0.5;
  EXPECT_NEAR(gravity.energy(network.positions) - gravity.energy(lower), work, 1e-13 * work * 20);
}

TEST(AirDrag, OpposesTheMotionRelativeToTheWind) {
  SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  network.velocities.col(0) = Vector3(2.0, 0.0, 1.0);
  const Points forces = forces_of(AirDrag(network, 0.5, Vector3(1.0, 0.0, 0.0)), network);
  EXPECT_EQ(forces.col(0), Vector3(-0.5, 0.0, -0.5));
  EXPECT_EQ(forces.col(1), Vector3(0.5, 0.0, 0.0));
}

// An integrator evaluates constant forces once.
TEST(Forces, AreConstantUnderGravityAlone) {
  for (const double stiffness : {0.0, 2.0}) {
    for (const double damping : {0.0, 1.0}) {
      const SpringNetwork network = make_pair(1.0, stiffness, 1.0, damping);
      Forces forces;
      forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
      forces.push_back(std::make_unique<SpringForce>(network));
      EXPECT_EQ(are_constant(forces), stiffness == 0.0 && damping == 0.0);
      forces.push_back(std::make_unique<AirDrag>(network, 0.5, Vector3::Zero()));
      EXPECT_FALSE(are_constant(forces));
    }
  }
}

// m v' = m g - c v from rest: v = (m g / c) (1 - exp(-c t / m)). For v, symplectic Euler is explicit Euler, with an error of at
// most (c / m) dt / 2 of the terminal velocity.
TEST(AirDrag, FallingBodiesApproachTheirTerminalVelocity) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0, 0.0, false, 0.25);
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, Vector3(0.0, -9.81, 0.0)));
  forces.push_back(std::make_unique<AirDrag>(network, 0.5, Vector3::Zero()));
  const double dt = 1.0e-4;
  const double terminal = -0.25 * 9.81 / 0.5;
  SimulationState state = initial_state(network);
  const auto integrator = make_integrator(SymplecticEulerSettings{}, network);
  integrator->start(state, forces, dt);
  for (; state.step < 100000; ++state.step) {
    const double expected = terminal * (1.0 - std::exp(-2.0 * static_cast<double>(state.step) * dt));
    ASSERT_NEAR(state.v(1, 0), expected, std::abs(terminal) * 2.0 * dt / 2.0);
    integrator->advance(state, forces, dt);
  }
  EXPECT_NEAR(state.v(1, 0), terminal, 1e-7 * std::abs(terminal)) << "exp(-20) is 2e-9";
}

TEST(AirDrag, OfAClothDoesNotDependOnItsResolution) {
  for (const Index side : {2, 5, 17}) {
    SpringNetwork network = make_test_cloth(side, 1.0, 0.0);
    network.velocities.row(2).setConstant(3.0);
    const Points forces = forces_of(AirDrag(network, 0.5, Vector3::Zero()), network);
    EXPECT_NEAR(forces.row(2).sum(), -0.5 * 1.0 * 3.0, 1e-13) << side;  // drag times 1 m^2 times 3 m/s
  }
}

TEST(AirDrag, OfARopeDoesNotDependOnItsResolution) {
  for (const Index particles : {2, 5, 17}) {
    NetworkBuilder builder;
    BodyShape rope = make_rope({{Vector3(0, 0, 0), Vector3(2, 0, 0)}, particles, std::nullopt}, {});
    set_total_mass(rope, 1.0);
    builder.add_body("rope", rope);
    SpringNetwork network = builder.build();
    network.velocities.row(2).setConstant(3.0);
    const Points forces = forces_of(AirDrag(network, 0.5, Vector3::Zero()), network);
    EXPECT_NEAR(forces.row(2).sum(), -0.5 * 2.0 * 3.0, 1e-13) << particles;  // drag times 2 m times 3 m/s
  }
}

TEST(Forces, ThatHaveNoPotentialHaveNoEnergy) {
  const SpringNetwork network = make_pair(1.0, 0.0, 1.0);
  EXPECT_EQ(AirDrag(network, 1.0, Vector3::Zero()).energy(network.positions), 0.0);
}

}  // namespace
}  // namespace sprung
