#include "collision/safe_regions/safe_region_motion.h"

#include "base/kernel.h"
#include "collision/core/float_box.h"
#include "collision/mesh_bvh/traversal_stack.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

SPRUNG_KERNEL void mark_children(const MeshBvh::Node& node, const FloatBox& box, Float8& bounds) {
  bounds = Float8{};
  for (int axis = 0; axis < 3; ++axis) {
    bounds = ((node.min[axis] > box.max[axis]) | (node.max[axis] < box.min[axis])) ? Float8{} + kInfinity : bounds;
  }
}

/// The square of the farthest that a corner of the block's triangles goes otherwise than by `drift`.
SPRUNG_KERNEL double farthest_otherwise(const TrianglePacket& before, const TrianglePacket& after, const Vector3& drift) {
  Double4 farthest{};
  for (int k = 0; k < 3; ++k) {
    Double4 squared{};
    for (int axis = 0; axis < 3; ++axis) {
      const Double4 otherwise = after.corner[k][axis] - before.corner[k][axis] - drift[axis];
      squared += otherwise * otherwise;
    }
    farthest = squared > farthest ? squared : farthest;
  }
  double result = 0.0;
  for (int lane = 0; lane < kSimdWidth; ++lane) result = std::max(result, farthest[lane]);
  return result;
}

/// The farthest that a corner of any triangle near the box goes otherwise than by `drift` [m].
double farthest_otherwise(const MeshBvh& before, const MeshBvh& after, const Box3& box, const Vector3& drift) {
  const FloatBox near = float_box(box);
  double farthest2 = 0.0;
  TraversalStack stack(after.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const std::int32_t child = stack.pop().child;
    if (child < 0) {
      farthest2 = std::max(farthest2, farthest_otherwise(before.block(~child), after.block(~child), drift));
      continue;
    }
    Float8 bounds;
    mark_children(after.node(child), near, bounds);
    stack.push_within(bounds, after.node(child).child, 0.0F);
  }
  return std::sqrt(farthest2);
}

}  // namespace

void shift(SafeRegion& region, const MeshBvh& before, const MeshBvh& after) {
  const Vector3& drift = region.drift;
  const Box3 way = region.box.merged(region.box.translated(drift));
  const double otherwise = farthest_otherwise(before, after, way, drift);
  region.box = shrunk(region.box.translated(drift), otherwise);
  for (int k = 0; k < region.plane_count; ++k) {
    HalfSpace& plane = region.planes[static_cast<std::size_t>(k)];
    plane.offset += plane.normal.dot(drift) + otherwise;
  }
  region.free_radius -= otherwise;
  region.clear = std::max(0.0, region.clear - otherwise);
  region.loss += otherwise;
  region.distance = std::max(0.0, region.distance - otherwise);
  region.point += drift;
}

}  // namespace sprung
