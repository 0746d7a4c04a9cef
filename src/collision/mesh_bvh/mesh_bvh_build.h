// How a mesh BVH is built: where FCL splits sets of triangles (surface area heuristic, SAH), and how its binary tree is collapsed
// into one with up to eight children per node.
#pragma once

#include "base/machine/simd.h"
#include "base/types.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/bvh/detail/BV_splitter_base.h>
#include <fcl/math/bv/AABB.h>
#include <array>
#include <vector>

namespace sprung {

/// Splits along the longest side of the box around the triangles' middles. Of 15 positions (Wald 2007) it takes the one with the
/// smallest sum of the areas of the two sets' boxes, each times its number of triangles (MacDonald and Booth 1990). FCL's own
/// splitter takes the mean, and traversals of its tree visit a sixth more blocks.
class SahSplitter final : public fcl::detail::BVSplitterBase<fcl::AABB<double>> {
 public:
  void set(fcl::Vector3<double>* vertices, fcl::Triangle* triangles, fcl::BVHModelType type) override;
  void computeRule(const fcl::AABB<double>& box, unsigned int* triangles, int count) override;
  /// Whether a triangle with this middle belongs to the second child.
  [[nodiscard]] bool apply(const fcl::Vector3<double>& middle) const override { return middle[axis_] > cut_; }
  void clear() override;

 private:
  [[nodiscard]] Vector3 middle(unsigned int triangle) const;
  [[nodiscard]] Box3 box(unsigned int triangle) const;

  const fcl::Vector3<double>* vertices_ = nullptr;
  const fcl::Triangle* triangles_ = nullptr;
  int axis_ = 0;
  double cut_ = 0.0;
};

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
