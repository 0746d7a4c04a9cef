#include "dynamics/constraints/enclosed_volume.h"

#include "dynamics/forces/pressure_force.h"
#include "dynamics/integrators/spectral_bounds.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <string>

#include <Eigen/Eigenvalues>

namespace sprung {
namespace {

/// A closed cube of 1 m with different masses at its corners.
SpringNetwork bag(double factor, double pressure) {
  BodyShape shape = make_solid({}, {});
  set_total_mass(shape, 1.0);
  for (std::size_t i = 0; i < shape.masses.size(); ++i) shape.masses[i] *= 1.0 + 0.2 * static_cast<double>(i);
  shape.volume_factor = factor;
  shape.pressure = pressure;
  NetworkBuilder builder;
  builder.add_particle({5.0, 5.0, 5.0}, 1.0);  // so that numbers within the body differ from those of the network
  builder.add_body("bag", shape);
  return builder.build();
}

double volume_of_bag(const SpringNetwork& network, const Points& positions) {
  return signed_volume(positions.rightCols(8), network.bodies[1].surface.triangles);
}

TEST(EnclosedVolume, PassesReachTheFactorAndConserveMomentum) {
  const SpringNetwork network = bag(1.5, 0.0);
  const EnclosedVolume volume(network);
  Points positions = network.positions;
  EXPECT_NEAR(volume.residual(positions), 0.5 / 1.5 / 1.0e-3, 1.0e-6);
  // Newton's method on one equation: the error of 1/3 falls below 1e-3 in four passes.
  for (int pass = 0; pass < 4; ++pass) volume.project(network.positions, positions, {});
  EXPECT_LE(volume.residual(positions), 1.0);
  EXPECT_NEAR(volume_of_bag(network, positions), 1.5, 1.5e-3);
  EXPECT_LT(((positions - network.positions) * network.masses).norm(), 1.0e-14);
  EXPECT_EQ(positions.col(0), network.positions.col(0));
}

TEST(EnclosedVolume, SeveralBagsKeepTheirOwnAndPinnedParticlesStay) {
  NetworkBuilder builder;
  for (const double factor : {1.2, 0.0, 0.7}) {
    BodyShape shape = make_solid({}, {});
    set_total_mass(shape, 1.0);
    shape.volume_factor = factor;
    builder.add_body("bag" + std::to_string(factor), shape);
  }
  builder.pin(3);
  const SpringNetwork network = builder.build();
  const EnclosedVolume volume(network);
  Points positions = network.positions;
  for (int pass = 0; pass < 10; ++pass) volume.project(network.positions, positions, {});
  const auto volume_of = [&](Index body) {
    return signed_volume(positions.middleCols(8 * body, 8), network.bodies[body].surface.triangles);
  };
  EXPECT_NEAR(volume_of(0), 1.2, 1.2e-3);
  EXPECT_EQ(positions.middleCols(8, 8), network.positions.middleCols(8, 8));
  EXPECT_NEAR(volume_of(2), 0.7, 0.7e-3);
  EXPECT_EQ(positions.col(3), network.positions.col(3));
}

TEST(PressureForce, IsTheNegativeGradientOfItsEnergyAndHasNoSum) {
  const SpringNetwork network = bag(0.0, 3.0);
  const PressureForce pressure(network);
  Points positions = network.positions;
  positions.col(3) += Vector3(0.1, -0.2, 0.05);
  EXPECT_DOUBLE_EQ(pressure.energy(positions), -3.0 * volume_of_bag(network, positions));
  Points forces = Points::Zero(3, network.particle_count());
  pressure.add({positions, positions}, forces);
  EXPECT_LT(forces.rowwise().sum().norm(), 1.0e-14);
  // The energy is linear in each coordinate, so a central difference is exact up to rounding: 1e-16 * 3 / 1e-3.
  constexpr double kStep = 1.0e-3;
  for (Index i = 0; i < network.particle_count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      Points moved = positions;
      moved(axis, i) += kStep;
      const double above = pressure.energy(moved);
      moved(axis, i) -= 2.0 * kStep;
      EXPECT_NEAR(forces(axis, i), (pressure.energy(moved) - above) / (2.0 * kStep), 1.0e-12);
    }
  }
}

TEST(PressureForce, ItsBoundHolds) {
  const SpringNetwork network = bag(0.0, 3.0);
  const PressureForce pressure(network);
  const Index n = 3 * network.particle_count();
  Eigen::MatrixXd derivative(n, n);
  for (Index k = 0; k < n; ++k) {
    Points moved = network.positions;
    Points forward = Points::Zero(3, network.particle_count());
    Points backward = forward;
    moved.reshaped()[k] += 0.5;
    pressure.add({moved, moved}, forward);
    moved.reshaped()[k] -= 1.0;
    pressure.add({moved, moved}, backward);
    derivative.col(k) = (forward - backward).reshaped();
  }
  for (Index k = 0; k < n; ++k) derivative.row(k) *= network.inverse_masses[k / 3];
  std::vector<LinearElement> elements;
  pressure.append_elements(elements);
  EXPECT_LE(derivative.eigenvalues().cwiseAbs().maxCoeff(), spectral_bounds(elements, network.inverse_masses).elastic);
}

}  // namespace
}  // namespace sprung
