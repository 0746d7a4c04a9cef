#include "collision/mesh_tree.h"
#include "collision/walk_stack.h"

#include "base/kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr float kFloatMin = std::numeric_limits<float>::min();
constexpr float kFloatMax = std::numeric_limits<float>::max();

/// A float somewhat above the square of a distance; finite, so that empty boxes, which are infinitely far, are never within it.
float bound_of(double squared) {
  return std::min(static_cast<float>(std::min(squared, 1e38)) * (1.0F + 0x1p-22F) + kFloatMin, kFloatMax);
}

/// A position between two floats a coordinate.
struct FloatRange {
  float low[3];
  float high[3];
};

FloatRange float_range(const Vector3& p) {
  FloatRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const auto nearest = static_cast<float>(p[axis]);
    const float rounding = std::abs(nearest) * 0x1p-23F + kFloatMin;
    range.low[axis] = nearest - rounding;
    range.high[axis] = nearest + rounding;
  }
  return range;
}

/// Appends the children whose box is within the bound, the nearest last. A box's squared distance is at most 6 roundings of 2^-24
/// too large, which the factor takes back.
SPRUNG_KERNEL void push_children(const MeshTree::Node& node, const FloatRange& p, float bound, WalkStack& stack) {
  TreeLanes sum = {};
  for (int axis = 0; axis < 3; ++axis) {
    const TreeLanes below = node.min[axis] - p.high[axis];
    const TreeLanes above = p.low[axis] - node.max[axis];
    const TreeLanes farther = below > above ? below : above;
    const TreeLanes outside = farther > 0.0F ? farther : TreeLanes{};
    sum += outside * outside;
  }
  stack.push_within(sum * (1.0F - 0x1p-20F), node.child, bound);
}

}  // namespace

std::optional<MeshTree::Nearest> MeshTree::nearest(const Vector3& p, double radius) const {
  if (!(radius > 0.0)) return std::nullopt;
  const FloatRange range = float_range(p);
  double best2 = radius * radius;
  float bound = bound_of(best2);
  Nearest best;
  WalkStack stack(stack_size_);
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const WalkEntry entry = stack.pop();
    if (entry.bound > bound) continue;
    if (entry.child < 0) {
      const Leaf& leaf = leaves_[static_cast<std::size_t>(~entry.child)];
      const ClosestPoint closest = closest_point_on_triangle(p, leaf.a, leaf.b, leaf.c);
      if (closest.squared_distance < best2) {
        best = {leaf.triangle, closest};
        best2 = closest.squared_distance;
        bound = bound_of(best2);
      }
      continue;
    }
    push_children(nodes_[static_cast<std::size_t>(entry.child)], range, bound, stack);
  }
  if (best.triangle == kNone) return std::nullopt;
  return best;
}

}  // namespace sprung
