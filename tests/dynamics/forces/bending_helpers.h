// Functions shared by the tests of resistance to bending.
#pragma once

#include "dynamics/forces/bending_angle_force.h"

#include <gmock/gmock.h>

#include <random>

namespace sprung::testing {

inline Points random_points(Index count, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-size, size);
  return Points::NullaryExpr(3, count, [&]() { return unit(random); });
}

inline Points forces_of(const SpringNetwork& network, const Points& x, const Points& v) {
  Points forces = Points::Zero(3, x.cols());
  BendingAngleForce(network).add({.x = x, .v = v}, forces);
  return forces;
}

inline Points forces_of(const SpringNetwork& network, const Points& x) { return forces_of(network, x, Points::Zero(3, x.cols())); }

/// Compares forces with central differences over 2 h of the energy.
inline void expect_gradient(const SpringNetwork& network, const Points& x, double h, double tolerance) {
  const BendingAngleForce force(network);
  const Points forces = forces_of(network, x);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Points there = x;
    Points back = x;
    there(i) += h;
    back(i) -= h;
    EXPECT_NEAR(forces(i), -(force.energy(there) - force.energy(back)) / (2.0 * h), tolerance) << "coordinate " << i;
  }
}

/// Forces without a sum and a torque, up to the rounding of some products.
inline void expect_balanced(const Points& x, const Points& forces) {
  Vector3 torque = Vector3::Zero();
  for (Index i = 0; i < x.cols(); ++i) torque += Vector3(x.col(i)).cross(Vector3(forces.col(i)));
  const double rounding = 1e-14 * (1.0 + forces.norm());
  EXPECT_LT(forces.rowwise().sum().norm(), rounding);
  EXPECT_LT(torque.norm(), 4.0 * rounding);
}

}  // namespace sprung::testing
