#include "collision/element_bvh/element_bvh.h"
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sprung {
namespace {

constexpr double kGrid = 0x1p-7;

/// Number of leaf pairs that may come near each other in three stacked cloths at rest, `offset` [m] from the origin.
std::size_t near_pairs(const Vector3& offset) {
  test::SelfNetwork network;
  for (const double height : {0.0, 2.0, 4.0}) {
    network.add_cloth(10, offset + height * kGrid * Vector3::UnitY(), kGrid * Vector3::UnitX(), kGrid * Vector3::UnitZ());
  }
  const CollisionSurface surface = network.surface(0.0);
  VertexBounds spheres(std::vector<double>(static_cast<std::size_t>(network.count()), 0x1p-3 * kGrid));
  for (Index i = 0; i < network.count(); ++i) spheres.reset(i, network.positions.col(i), network.positions.col(i));
  std::vector<Index> all(network.elements.size());
  std::iota(all.begin(), all.end(), 0);
  ElementBvh tree(surface, network.positions);
  tree.bound(spheres, std::vector<char>(static_cast<std::size_t>(network.count()), 0), all, {.now = 0.0, .end = 1.0});
  return tree.find_pairs({.now = 0.0, .end = 1.0}, 0x1p-3 * kGrid).size();
}

// Positions are multiples of 2^-20, so that an offset of 2^22, typical of map coordinates, is exact. Single precision relative to
// the world's origin would be coarser than the distance of the cloths, and all pairs would seem near. Centroids, which sort
// elements into leaves, are rounded, so that some leaves get other elements and a few more pairs.
TEST(ElementBvh, FindsHardlyMorePairsFarFromTheOrigin) {
  const std::size_t near = near_pairs(Vector3::Zero());
  EXPECT_GT(near, 0u);
  EXPECT_LT(near_pairs({0x1p22, -0x1p22, 0x1p20}), near + near / 8);
}

}  // namespace
}  // namespace sprung
