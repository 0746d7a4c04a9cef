#include "dynamics/forces/angle_dampers.h"

#include "dynamics/forces/bending_angle_force.h"
#include "network/network_builder.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

constexpr double kDamping = 0.3;  // [N m s]

/// A chain of five particles, 1 m apart, with three angle bends.
SpringNetwork chain() {
  NetworkBuilder builder;
  for (int i = 0; i < 5; ++i) builder.add_particle(Vector3(i, 0.0, 0.0), 1.0);
  for (Index i = 0; i < 3; ++i) builder.add_angle_bend(i, i + 1, i + 2, 1.0, kDamping);
  return builder.build();
}

/// Bent positions whose bonds are at least as long as at rest.
Points bent(double by) {
  Points x(3, 5);
  for (Index i = 0; i < 5; ++i) x.col(i) = Vector3(1.2 * i, by * i * i, 0.1 * by * (i % 2));
  return x;
}

TEST(AngleDampers, AreTheDampersOfBendsAtThePositionsHeld) {
  const SpringNetwork network = chain();
  const ElementConstants dampers_alone{std::vector<double>(3, 0.0), std::vector<double>(3, kDamping)};
  const BendingAngleForce bends(network, dampers_alone);
  AngleDampers dampers(network, std::vector<double>(3, kDamping));
  for (const double by : {0.3, 0.7}) {
    const Points x = bent(by);
    dampers.hold(x);
    for (int trial = 0; trial < 3; ++trial) {
      const Points v = Points::Random(3, 5);
      Points expected = Points::Zero(3, 5);
      Points found = Points::Zero(3, 5);
      bends.add({.x = x, .v = v, .time = 0.0}, expected);
      dampers.add({.x = x, .v = v, .time = 0.0}, found);
      EXPECT_GT(expected.norm(), 1e-3);
      // The same products, rounded in another order.
      EXPECT_LE((found - expected).norm(), 1e-14 * expected.norm()) << by;
    }
  }
}

// A gradient grows with 1 / length: of bonds half as long, a damper has a quarter of its strength for each.
TEST(AngleDampers, AreWeakerWhereBondsAreShort) {
  const SpringNetwork network = chain();
  const BendingAngleForce bends(network, {std::vector<double>(3, 0.0), std::vector<double>(3, kDamping)});
  AngleDampers dampers(network, std::vector<double>(3, kDamping));
  Points x(3, 5);
  for (Index i = 0; i < 5; ++i) x.col(i) = Vector3(0.5 * i, 0.0, 0.0);
  x(1, 4) = 1e-9;  // in line, nothing tells the plane of a bend
  x(1, 0) = 1e-9;
  x(1, 2) = 1e-9;
  const Points v = Points::Random(3, 5);
  Points whole = Points::Zero(3, 5);
  Points found = Points::Zero(3, 5);
  bends.add({.x = x, .v = v, .time = 0.0}, whole);
  dampers.hold(x);
  dampers.add({.x = x, .v = v, .time = 0.0}, found);
  EXPECT_LE((16.0 * found - whole).norm(), 1e-8 * whole.norm());
}

TEST(AngleDampers, InLineDoNothing) {
  const SpringNetwork network = chain();
  AngleDampers dampers(network, std::vector<double>(3, kDamping));
  dampers.hold(bent(0.5));
  dampers.hold(network.positions);
  Points found = Points::Zero(3, 5);
  dampers.add({.x = network.positions, .v = Points::Random(3, 5), .time = 0.0}, found);
  EXPECT_EQ(found, Points::Zero(3, 5));
}

}  // namespace
}  // namespace sprung
