// Collapses FCL's binary tree into a tree with up to eight children per node.
#pragma once

#include "base/simd.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <array>
#include <vector>

namespace sprung {

/// Chooses the nodes of the binary tree to leave out so that the total cost is smallest: the sum of the costs of nodes and blocks,
/// each times the area of its box, which is proportional to the number of its visits (Ylitie, Karras and Laine 2017).
class WideBvhCollapse {
 public:
  using Tree = fcl::BVHModel<fcl::AABB<double>>;

  /// Keeps a reference to the tree, which must have been built.
  explicit WideBvhCollapse(const Tree& tree);

  /// Whether the node has so few triangles that they become one block.
  [[nodiscard]] bool is_block(int bv) const { return tree_.getBV(bv).num_primitives <= kSimdWidth; }

  /// The nodes below `bv`, at most kFloatSimdWidth, that become its children. Requires that `bv` is not a block.
  [[nodiscard]] std::vector<int> children(int bv) const;

 private:
  /// Entry i: the lowest cost of a node and all below it if they may use up to i + 1 lanes of the parent.
  using Costs = std::array<float, kFloatSimdWidth - 1>;

  struct Share {
    int first_lanes;  ///< of the first child; the second has the others
    float cost;
  };
  [[nodiscard]] Share best_share(int first_child, int lanes) const;
  void gather(int bv, int lanes, std::vector<int>& children) const;

  const Tree& tree_;
  std::vector<Costs> costs_;
};

}  // namespace sprung
