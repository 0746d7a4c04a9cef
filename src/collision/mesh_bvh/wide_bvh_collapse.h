// FCL's binary tree made wide: which of its nodes become the children of a node with eight.
#pragma once

#include "base/simd.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <array>
#include <vector>

namespace sprung {

/// Of all ways to leave nodes out, the one with the least cost: the sum of a node's cost, each times the area of its box, to which
/// the number of walks that visit it is proportional (Ylitie, Karras and Laine 2017).
class WideBvhCollapse {
 public:
  using Tree = fcl::BVHModel<fcl::AABB<double>>;

  /// Keeps a reference to the tree, which must have been built.
  explicit WideBvhCollapse(const Tree& tree);

  /// Whether so few triangles are below that they become one block.
  [[nodiscard]] bool is_block(int bv) const { return tree_.getBV(bv).num_primitives <= kSimdWidth; }

  /// The nodes below `bv`, at most kFloatSimdWidth, that become its children. Requires that it is no block.
  [[nodiscard]] std::vector<int> children(int bv) const;

 private:
  /// Entry i: the least cost of all below a node when up to i + 1 of its parent's lanes hold it.
  using Costs = std::array<float, kFloatSimdWidth - 1>;

  struct Share {
    int first_lanes;  ///< for the first child; the second has the others
    float cost;
  };
  [[nodiscard]] Share best_share(int first_child, int lanes) const;
  void gather(int bv, int lanes, std::vector<int>& children) const;

  const Tree& tree_;
  std::vector<Costs> costs_;
};

}  // namespace sprung
