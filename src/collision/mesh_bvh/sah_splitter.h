// Surface area heuristic (SAH): where FCL splits a set of triangles when it builds its tree.
#pragma once

#include "base/types.h"

#include <fcl/geometry/bvh/detail/BV_splitter_base.h>
#include <fcl/math/bv/AABB.h>

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

}  // namespace sprung
