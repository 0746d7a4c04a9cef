#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/mesh_bvh/traversal_stack.h"
#include "collision/mesh_bvh/triangle_packet_distance.h"

#include "base/kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr float kFloatMin = std::numeric_limits<float>::min();
constexpr float kFloatMax = std::numeric_limits<float>::max();

/// A float slightly above the square of a distance. It is finite, so that an empty box, whose distance is infinite, is never
/// nearer.
float bound_of(double squared) {
  return std::min(static_cast<float>(std::min(squared, 1e38)) * (1.0F + 0x1p-22F) + kFloatMin, kFloatMax);
}

/// A position whose coordinates are each between two floats.
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

/// Lower bounds of the children's squared distances. Rounding makes the squared distance of a box too large by at most 6 times
/// 2^-24, which the factor compensates.
[[gnu::always_inline]] inline void bound_children(const MeshBvh::Node& node, const FloatRange& p, Float8& bounds) {
  Float8 sum = {};
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 below = node.min[axis] - p.high[axis];
    const Float8 above = p.low[axis] - node.max[axis];
    const Float8 farther = below > above ? below : above;
    const Float8 outside = farther > 0.0F ? farther : Float8{};
    sum += outside * outside;
  }
  bounds = sum * (1.0F - 0x1p-20F);
}

/// A triangle of a block; none if the block is null.
struct Spot {
  const TrianglePacket* block = nullptr;
  int lane = 0;
};

/// The triangle with the smallest squared distance below `best2`.
SPRUNG_KERNEL Spot find_nearest(const MeshBvh& tree, const Vector3& p, double best2) {
  const FloatRange range = float_range(p);
  float bound = bound_of(best2);
  Spot best;
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.bound > bound) continue;
    if (entry.child >= 0) {
      const MeshBvh::Node& node = tree.node(entry.child);
      Float8 bounds;
      bound_children(node, range, bounds);
      stack.push_within(bounds, node.child, bound);
      continue;
    }
    const TrianglePacket& block = tree.block(~entry.child);
    Double4 squared;
    squared_distances(p, block, squared);
    const Mask4 nearer = squared < best2;
    for (unsigned lanes = mask_bits(nearer); lanes != 0;) {
      const int lane = pop_lane(lanes);
      if (!(squared[lane] < best2)) continue;
      best2 = squared[lane];
      best = {&block, lane};
    }
    bound = bound_of(best2);
  }
  return best;
}

}  // namespace

std::optional<MeshBvh::Nearest> MeshBvh::nearest(const Vector3& p, double radius) const {
  if (!(radius > 0.0)) return std::nullopt;
  const auto [block, lane] = find_nearest(*this, p, radius * radius);
  if (block == nullptr) return std::nullopt;
  const auto corners = block->corners(lane);
  return Nearest{block->triangle[lane], closest_point_on_triangle(p, corners[0], corners[1], corners[2]), corners};
}

}  // namespace sprung
