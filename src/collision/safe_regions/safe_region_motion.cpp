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

SPRUNG_KERNEL void bound_children(const MeshBvh::Node& node, const FloatBox& box, Float8& bounds) {
  bounds = Float8{};
  for (int axis = 0; axis < 3; ++axis) {
    bounds = ((node.min[axis] > box.max[axis]) | (node.max[axis] < box.min[axis])) ? Float8{} + kInfinity : bounds;
  }
}

/// The largest squared difference [m^2] between `drift` and the displacement of a corner in the packet.
SPRUNG_KERNEL double max_deviation(const TrianglePacket& before, const TrianglePacket& after, const Vector3& drift) {
  Double4 farthest{};
  for (int k = 0; k < 3; ++k) {
    Double4 squared{};
    for (int axis = 0; axis < 3; ++axis) {
      const Double4 deviation = after.corner[k][axis] - before.corner[k][axis] - drift[axis];
      squared += deviation * deviation;
    }
    farthest = squared > farthest ? squared : farthest;
  }
  double result = 0.0;
  for (int lane = 0; lane < kSimdWidth; ++lane) result = std::max(result, farthest[lane]);
  return result;
}

/// The largest difference [m] between `drift` and the displacement of a corner of a triangle near the box.
double max_deviation(const MeshBvh& before, const MeshBvh& after, const Box3& box, const Vector3& drift) {
  const FloatBox near = float_box(box);
  double farthest2 = 0.0;
  TraversalStack stack(after.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const std::int32_t child = stack.pop().child;
    if (child < 0) {
      farthest2 = std::max(farthest2, max_deviation(before.block(~child), after.block(~child), drift));
      continue;
    }
    Float8 bounds;
    bound_children(after.node(child), near, bounds);
    stack.push_within(bounds, after.node(child).child, 0.0F);
  }
  return std::sqrt(farthest2);
}

}  // namespace

void shift(SafeRegion& region, const MeshBvh& before, const MeshBvh& after) {
  const Vector3& drift = region.drift;
  const Box3 swept = region.box.merged(region.box.translated(drift));
  const double deviation = max_deviation(before, after, swept, drift);
  region.box = shrunk(region.box.translated(drift), deviation);
  for (int k = 0; k < region.plane_count; ++k) {
    HalfSpace& plane = region.planes[static_cast<std::size_t>(k)];
    plane.offset += plane.normal.dot(drift) + deviation;
  }
  region.free_radius -= deviation;
  region.clear = std::max(0.0, region.clear - deviation);
  region.loss += deviation;
  region.distance = std::max(0.0, region.distance - deviation);
  region.point += drift;
}

}  // namespace sprung
