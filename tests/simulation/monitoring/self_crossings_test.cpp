#include "simulation/monitoring/self_crossings.h"

#include "network/network_builder.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// A strip of 5 x 2 particles, 1 m long, in the plane z = 0: particles 0 to 4 at y = -0.05, 5 to 9 at y = 0.05.
SpringNetwork strip(const BodyContact& contact) {
  BodyShape shape = make_cloth({.size = {1.0, 0.1}, .resolution = {5, 2}}, {});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("strip", shape, {}, contact);
  return builder.build();
}

/// Its last column moved to a slanted line through the first cell: from (-0.4, 0.01, -0.1) to (-0.3, 0, 0.1).
Points crossed(const SpringNetwork& network) {
  Points x = network.positions;
  x.col(4) = Vector3(-0.4, 0.01, -0.1);
  x.col(9) = Vector3(-0.3, 0.0, 0.1);
  return x;
}

// The last column is a side of one triangle, which pierces the first cell. Its neighbours reach that triangle's other sides.
TEST(SelfCrossings, BodyWithoutSelfContactIsCounted) {
  const SpringNetwork network = strip({.self = false});
  EXPECT_TRUE(find_self_crossings(network, network.positions).empty());
  const std::vector<SelfCrossing> found = find_self_crossings(network, crossed(network));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].body, 0);
  EXPECT_GE(found[0].elements, 2);
}

TEST(SelfCrossings, ShapeThatCrossesItselfAtTheStartIsMeant) {
  SpringNetwork network = strip({.self = false});
  network.positions = crossed(network);
  EXPECT_TRUE(find_self_crossings(network, network.positions).empty());
}

TEST(SelfCrossings, BodyWithSelfContactIsNotLookedAt) {
  const SpringNetwork network = strip({.self = true});
  EXPECT_TRUE(find_self_crossings(network, crossed(network)).empty());
}

TEST(SelfCrossings, RopeInAPlaneMayCrossItself) {
  BodyShape shape = make_rope({.points = {Vector3(0, 0, 0), Vector3(3, 0, 0)}, .particles = 4, .length = {}}, {});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("rope", shape, {}, {});
  const SpringNetwork network = builder.build();
  Points x = network.positions;  // the last segment crosses the first one
  x.col(2) = Vector3(1.0, 1.0, 0.0);
  x.col(3) = Vector3(0.5, -1.0, 0.0);
  EXPECT_TRUE(find_self_crossings(network, x).empty());
}

}  // namespace
}  // namespace sprung
