#include "dynamics/forces/bending_angle_force.h"

#include "base/parallel.h"
#include "dynamics/forces/bending_helpers.h"
#include "network/network_builder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

using testing::expect_balanced;
using testing::expect_gradient;
using testing::forces_of;
using testing::random_points;

constexpr double kStiffness = 3.0;
constexpr double kDamping = 0.7;

/// Three particles in line along x, 1 m and 2 m apart.
SpringNetwork hinge(double damping = 0.0) {
  NetworkBuilder builder;
  for (const double x : {0.0, 1.0, 3.0}) builder.add_particle(Vector3(x, 0, 0), 0.5);
  builder.add_angle_bend(0, 1, 2, kStiffness, damping);
  return builder.build();
}

TEST(BendingAngleForce, RightAngleTurnsBondsByItsMoment) {
  // k pi / 2, divided by the bonds' lengths, towards the line.
  const Points x = (Points(3, 3) << 0, 1, 1, 0, 0, 2, 0, 0, 0).finished();
  const Points forces = forces_of(hinge(), x);
  const double moment = kStiffness * std::numbers::pi / 2.0;
  EXPECT_LT((forces.col(0) - Vector3(0, -moment, 0)).norm(), 1e-14);
  EXPECT_LT((forces.col(2) - Vector3(moment / 2.0, 0, 0)).norm(), 1e-14);
  EXPECT_DOUBLE_EQ(BendingAngleForce(hinge()).energy(x), 0.5 * kStiffness * std::pow(std::numbers::pi / 2.0, 2));
}

TEST(BendingAngleForce, IsTheNegativeGradientOfItsEnergy) {
  // In a box of 3 m bonds have any length; in a box of 0.3 m they are shorter than half of their rest length. Differences are off
  // by h^2 times the third derivative, some k / bond^3, which is at most 1e3 / size^3 here.
  for (unsigned trial = 0; trial < 60; ++trial) {
    const double size = trial % 2 == 0 ? 3.0 : 0.3;
    SCOPED_TRACE(trial);
    expect_gradient(hinge(), random_points(3, trial, size), 1e-6 * size, 1e-6 / size);
  }
}

TEST(BendingAngleForce, HasNoNetForceAndNoNetTorque) {
  for (unsigned trial = 0; trial < 20; ++trial) {
    const Points x = random_points(3, trial, trial % 2 == 0 ? 2.0 : 0.3);
    expect_balanced(x, forces_of(hinge(kDamping), x, random_points(3, 100 + trial, 1.0)));
  }
}

TEST(BendingAngleForce, AStraightBendIsAtRestAtAnyLength) {
  const SpringNetwork network = hinge();
  for (const double stretch : {0.1, 1.0, 7.0}) {
    const Points x = stretch * network.positions;
    EXPECT_EQ(forces_of(network, x), Points::Zero(3, 3));
    EXPECT_EQ(BendingAngleForce(network).energy(x), 0.0);
  }
}

TEST(BendingAngleForce, RigidMotionsCostNothing) {
  const SpringNetwork network = hinge(kDamping);
  const Points x = (Points(3, 3) << 0, 1, 1.5, 0, 0, 1, 0, 0.2, 1).finished();
  const Eigen::Matrix3d turn = rotation_from_degrees({20, 50, -70});
  const Points turned = (turn * x).colwise() + Vector3(3, -2, 1);
  EXPECT_NEAR(BendingAngleForce(network).energy(turned), BendingAngleForce(network).energy(x), 1e-13);
  EXPECT_LT((forces_of(network, turned) - turn * forces_of(network, x)).norm(), 1e-13);
  // Damping does not act on a rigid motion either: v = omega x r + a drift.
  const Vector3 omega(0.3, -1.0, 2.0);
  Points v(3, 3);
  for (Index i = 0; i < 3; ++i) v.col(i) = omega.cross(Vector3(x.col(i))) + Vector3(1, 1, 4);
  EXPECT_LT((forces_of(network, x, v) - forces_of(network, x)).norm(), 1e-14);
}

TEST(BendingAngleForce, DampingTakesTheSquareOfTheAnglesRate) {
  const Points x = (Points(3, 3) << 0, 1, 1.5, 0, 0, 1, 0, 0.2, 1).finished();
  const Points v = random_points(3, 5, 1.0);
  const auto angle = [&](double time) {
    const Points moved = x + time * v;
    const Vector3 a = moved.col(1) - moved.col(0);
    const Vector3 b = moved.col(2) - moved.col(1);
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  const double rate = (angle(1e-6) - angle(-1e-6)) / 2e-6;
  const double power = (forces_of(hinge(kDamping), x, v) - forces_of(hinge(), x)).cwiseProduct(v).sum();
  EXPECT_NEAR(power, -kDamping * rate * rate, 1e-8);
}

TEST(BendingAngleForce, FoldedAndCollapsedBondsHaveFiniteForces) {
  const double tiny = 1e-200;
  const std::vector<Points> states{
      (Points(3, 3) << 0, 1, 0, 0, 0, 0, 0, 0, 0).finished(),     // folded back onto itself
      (Points(3, 3) << 0, 1, 0, 0, 0, 1e-9, 0, 0, 0).finished(),  // almost
      (Points(3, 3) << 0, 1, 0, 0, 0, tiny, 0, 0, 0).finished(),  // the square of the distance underflows
      (Points(3, 3) << 1, 1, 2, 0, 0, 1, 0, 0, 0).finished(),     // a bond without length
      (Points(3, 3) << 1, 1, 2, 0, tiny, 1, 0, 0, 0).finished(),  // almost
      (Points(3, 3) << 1, 1 + 1e-12, 2, 0, 1e-12, -1, 0, 0, 0).finished(),
      Points::Zero(3, 3)};
  // A bond of its rest length feels k pi; below half of it no more than 4 k pi / rest length, and as much again from f.
  const double largest = 30.0 * kStiffness * std::numbers::pi;
  for (const Points& x : states) {
    const Points forces = forces_of(hinge(kDamping), x);
    EXPECT_TRUE(forces.allFinite()) << x;
    EXPECT_LT(forces.norm(), largest) << x;
    EXPECT_TRUE(std::isfinite(BendingAngleForce(hinge()).energy(x))) << x;
  }
}

/// More particles than one thread takes at a time: rows and columns of elements continue from one thread's particles to the next.
SpringNetwork large_cloth() {
  BodyShape shape = make_cloth({.resolution = {90, 80}}, {.bend = SpringMaterial{.value = 0.1, .damping = 0.01},
                                                          .bend_model = SpringMaterials::BendModel::angle});
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  return builder.build();
}

TEST(BendingAngleForce, HasTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork cloth = large_cloth();
  const Points x = cloth.positions + random_points(cloth.particle_count(), 3, 0.005);
  const Points v = random_points(cloth.particle_count(), 4, 1.0);
  const Points forces = forces_of(cloth, x, v);
  const ThreadLimit one(1);
  EXPECT_EQ(forces_of(cloth, x, v), forces);
  EXPECT_GT(forces.norm(), 0.0);
}

// The tolerance is the rounding of as many sums as there are particles, of forces as large as the largest.
TEST(BendingAngleForce, OfALargeClothHasNoNetForce) {
  const SpringNetwork cloth = large_cloth();
  const Index count = cloth.particle_count();
  const Points forces = forces_of(cloth, cloth.positions + random_points(count, 3, 0.005), random_points(count, 4, 1.0));
  EXPECT_LT(forces.rowwise().sum().norm(), 1e-16 * count * forces.colwise().norm().maxCoeff());
}

}  // namespace
}  // namespace sprung
