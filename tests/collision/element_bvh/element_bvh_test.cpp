#include "collision/element_bvh/element_bvh.h"
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sprung {
namespace {

constexpr double kGrid = 0x1p-7;

/// How many pairs of leaves may come near each other, of three cloths above each other that rest `way` [m] from the origin.
std::size_t near_pairs(const Vector3& way) {
  test::SelfNetwork network;
  for (const double height : {0.0, 2.0, 4.0}) {
    network.add_cloth(10, way + height * kGrid * Vector3::UnitY(), kGrid * Vector3::UnitX(), kGrid * Vector3::UnitZ());
  }
  const CollisionSurface surface = network.surface(0.0);
  VertexBounds balls(std::vector<double>(static_cast<std::size_t>(network.count()), 0x1p-3 * kGrid));
  for (Index i = 0; i < network.count(); ++i) balls.place(i, network.positions.col(i), network.positions.col(i));
  std::vector<Index> all(network.elements.size());
  std::iota(all.begin(), all.end(), 0);
  ElementBvh tree(surface, network.positions);
  tree.bound(balls, std::vector<char>(static_cast<std::size_t>(network.count()), 0), all, {.now = 0.0, .end = 1.0});
  return tree.find_pairs({.now = 0.0, .end = 1.0}, 0x1p-3 * kGrid).size();
}

// Positions are multiples of 2^-20, so that a way of 2^22, as coordinates of maps have it, takes nothing from them. Single
// precision from the world's origin would be coarser there than the cloths are apart, and all would seem near. Thirds of
// coordinates, by which elements are sorted into leaves, are rounded, so that some have other neighbours: a sixteenth more pairs
// of leaves were seen.
TEST(ElementBvh, FindsNoMoreFarFromTheOrigin) {
  const std::size_t near = near_pairs(Vector3::Zero());
  EXPECT_GT(near, 0u);
  EXPECT_LT(near_pairs({0x1p22, -0x1p22, 0x1p20}), near + near / 8);
}

}  // namespace
}  // namespace sprung
