#include "collision/mesh_tree.h"
#include "collision/walk_stack.h"

#include "base/kernel.h"

#include <algorithm>
#include <limits>

namespace sprung {

namespace {

constexpr float kFloatMax = std::numeric_limits<float>::max();

/// The smallest float that is not below value; finite, so that empty boxes, which are infinitely far, are never within it.
float rounded_up(double value) {
  if (!(value < static_cast<double>(kFloatMax))) return kFloatMax;
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value ? std::nextafter(nearest, kFloatMax) : nearest;
}

/// A position between two floats a coordinate.
struct FloatRange {
  float low[3];
  float high[3];
};

FloatRange float_range(const Vector3& p) {
  FloatRange range;
  for (int axis = 0; axis < 3; ++axis) {
    range.high[axis] = rounded_up(p[axis]);
    range.low[axis] = -rounded_up(-p[axis]);
  }
  return range;
}

/// Lower bounds of the squared distances from p to a node's boxes. Each is at most 6 roundings of 2^-24 too large, which the factor
/// takes back.
SPRUNG_KERNEL void squared_distances(const MeshTree::Node& node, const FloatRange& p, float* result) {
  constexpr float kShrink = 1.0F - 0x1p-20F;
  for (int lane = 0; lane < MeshTree::kLanes; ++lane) {
    float sum = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const float below = node.min[axis][lane] - p.high[axis];
      const float above = p.low[axis] - node.max[axis][lane];
      const float outside = std::max(std::max(below, above), 0.0F);
      sum += outside * outside;
    }
    result[lane] = sum * kShrink;
  }
}

}  // namespace

std::optional<MeshTree::Nearest> MeshTree::nearest(const Vector3& p, double radius) const {
  if (!(radius > 0.0)) return std::nullopt;
  const FloatRange range = float_range(p);
  double best2 = radius * radius;
  float bound = rounded_up(best2);
  Nearest best;
  WalkStack stack(static_cast<std::size_t>(stack_size_));
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
        bound = rounded_up(best2);
      }
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.child)];
    alignas(32) float distances[kLanes];
    squared_distances(node, range, distances);
    const std::size_t base = stack.size();
    for (int lane = 0; lane < kLanes; ++lane) {
      if (distances[lane] <= bound) stack.push_sorted({distances[lane], node.child[lane]}, base);
    }
  }
  if (best.triangle == kNone) return std::nullopt;
  return best;
}

}  // namespace sprung
