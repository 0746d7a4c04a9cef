// How often the neighbour list is renewed, and how much it lists.
#include "collision/pairs/neighbour_list.h"

#include "collision/self_networks.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.01;
constexpr double kThickness = 0.003;
constexpr double kMargin = 0.001;

SelfNetwork cloth() {
  SelfNetwork network;
  network.add_cloth(20, Vector3::Zero(), kEdge * Vector3::UnitX(), kEdge * Vector3::UnitZ());
  return network;
}

// Gravity moves a particle out of its sphere, a tenth of an edge, in sqrt(0.2 edge / g) = 14 ms or 17 steps.
TEST(NeighbourList, KeepsTheSpheresOfAFallingClothForManySteps) {
  const SelfNetwork network = cloth();
  const CollisionSurface surface = network.surface(kThickness);
  NeighbourList list(surface, network.positions, kMargin);
  Points x = network.positions;
  Points sphere_motion = Points::Zero(3, network.count());
  Index resets = 0;
  const double dt = 1.0 / 1200.0;
  for (int step = 0; step < 100; ++step) {
    Points targets = x;
    targets.row(1).array() -= 10.0 * dt + 9.81 * dt * dt * (step + 0.5);
    list.begin_step(x, targets);
    for (Index i = 0; i < network.count(); ++i) {
      resets += step > 0 && list.spheres().motion(i) != sphere_motion.col(i) ? 1 : 0;
      sphere_motion.col(i) = list.spheres().motion(i);
    }
    x = targets;
  }
  EXPECT_LE(resets, 6 * network.count());
}

// In free fall the list lasts for up to 64 steps. A cloth that stops would keep the pairs along its former path: 190 times as many
// as a new list has.
TEST(NeighbourList, IsRenewedEarlyWhenAFallingClothStops) {
  const SelfNetwork network = cloth();
  const CollisionSurface surface = network.surface(kThickness);
  NeighbourList list(surface, network.positions, kMargin);
  PairSeparation separation(surface, network.positions, kMargin);
  Points x = network.positions;
  for (int step = 0; step < 10; ++step) {
    Points targets = x;
    targets.row(1).array() -= 0.5 * kEdge;
    list.begin_step(x, targets);
    x = targets;
  }
  test::Random random(7);
  for (int step = 0; step < 5; ++step) {
    Points targets = x;
    for (Index i = 0; i < network.count(); ++i) targets.col(i) += random.between(0.0, 0.5 * kEdge) * random.direction();
    NeighbourList anew(surface, network.positions, kMargin);
    anew.begin_step(x, targets);
    list.begin_step(x, targets);
    const auto count = static_cast<std::size_t>(network.count());
    EXPECT_LE(list.pairs().size(), 2 * anew.pairs().size() + count) << step;
    EXPECT_LE(list.candidates().size(), 2 * anew.candidates().size() + count) << step;
    std::vector<Contact> contacts;
    separation.begin_step(x, targets, contacts);
    test::truncate(separation, x, targets);
    x = targets;
  }
}

}  // namespace
}  // namespace sprung
