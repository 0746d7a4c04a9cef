#include "collision/safe_regions/mesh_safe_region.h"

#include "base/machine/kernel.h"
#include "collision/mesh_bvh/traversal_stack.h"
#include "collision/safe_regions/safe_region_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Rounding error of a sum of three products in single precision, as a fraction of the largest coordinate.
constexpr float kPlaneRounding = 0x1p-20F;

// The search for triangles extends to this multiple of the reach. A region without a triangle that near stays valid for longer.
constexpr double kSearchFactor = 16.0;

// The nearest-triangle search does not visit a node beyond this fraction of the squared clear distance. Its bound lowers the clear
// distance instead, which costs less than the exact distance.
constexpr float kPruneFraction = 0.5F;

Box3 grown(const Box3& box, double reach) { return {box.min().array() - reach, box.max().array() + reach}; }

double box_distance(const TriangleCorners& corners, const Box3& box) {
  Box3 of_triangle(corners[0]);
  of_triangle.extend(corners[1]).extend(corners[2]);
  return of_triangle.exteriorDistance(box);
}

/// Bounds beyond which a traversal skips nodes, in single precision.
struct Search {
  FloatBox element{};
  FloatBox box{};
  float normal[SafeRegion::kMostPlanes][3]{};
  float limit[SafeRegion::kMostPlanes]{};
  int planes = 0;
  float rounding = 0.0F;  ///< of heights above planes [m]
};

Search search_around(const MeshBvh& tree, const Box3& element, const Box3& box) {
  const double magnitude = std::max(tree.magnitude(), box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff());
  return {.element = float_box(element), .box = float_box(box), .rounding = kPlaneRounding * static_cast<float>(magnitude)};
}

void set_plane(int k, const Vector3& normal, double limit, Search& search) {
  for (int axis = 0; axis < 3; ++axis) search.normal[k][axis] = static_cast<float>(normal[axis]);
  search.limit[k] = float_below(limit) - search.rounding;
}

void update(const SafeRegionBuilder& region, Search& search) {
  search.box = float_box(region.box());
  for (; search.planes < region.plane_count(); ++search.planes) {
    set_plane(search.planes, region.normal(search.planes), region.limit(search.planes), search);
  }
}

/// Squared distances [m^2] of a node's children from the element. Infinite for a child outside the box or behind a plane.
[[gnu::always_inline]] inline void bound_children(const MeshBvh::Node& node, const Search& search, Float8& bounds) {
  Float8 sum = {};
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 before = node.min[axis] - search.element.max[axis];
    const Float8 behind = search.element.min[axis] - node.max[axis];
    const Float8 farther = before > behind ? before : behind;
    const Float8 outside = farther > 0.0F ? farther : Float8{};
    sum += outside * outside;
    const auto beside = (node.min[axis] > search.box.max[axis]) | (node.max[axis] < search.box.min[axis]);
    sum = beside ? Float8{} + kInfinity : sum;
  }
  for (int k = 0; k < search.planes; ++k) {
    Float8 highest = {};
    for (int axis = 0; axis < 3; ++axis) {
      const float n = search.normal[k][axis];
      highest += n * (n > 0.0F ? node.max[axis] : node.min[axis]);
    }
    sum = highest < search.limit[k] ? Float8{} + kInfinity : sum;
  }
  bounds = sum;
}

/// Visits the triangles that may be nearer than both the nearest one so far and the clear distance.
SPRUNG_KERNEL void visit_nearest(const MeshBvh& tree, double near, const SafeRegion& region, SafeRegionBuilder& builder) {
  Search search = search_around(tree, builder.element_box(), grown(builder.element_box(), builder.clear_distance()));
  const auto limit = [&] {
    const double nearest = std::min(region.distance, builder.clear_distance());
    return static_cast<float>(std::min(nearest * nearest, 1e38)) * (1.0F + 0x1p-20F);
  };
  const auto squared_near = static_cast<float>(near * near) * (1.0F + 0x1p-20F);
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.bound > limit()) continue;
    if (entry.bound > squared_near && entry.bound > kPruneFraction * limit()) {
      builder.limit_clear_distance((1.0 - 0x1p-20) * std::sqrt(static_cast<double>(entry.bound)));
      continue;
    }
    if (region.triangle != kNone) {
      set_plane(0, region.normal, builder.nearest_limit(), search);
      search.planes = 1;
    }
    if (entry.child < 0) {
      const TrianglePacket& packet = tree.block(~entry.child);
      Double4 distances;
      squared_box_distances(packet, builder.element_box(), distances);
      unsigned lanes = packet.lanes();
      if (region.triangle != kNone) lanes &= triangles_above(packet, region.normal, builder.nearest_limit());
      while (lanes != 0) {
        const int lane = pop_smallest_lane(distances, lanes);
        if (distances[lane] > limit()) break;
        if (distances[lane] >= near * near) {
          builder.limit_clear_distance(std::sqrt(distances[lane]));
          break;
        }
        builder.consider(packet.triangle[lane], packet.corners(lane));
      }
      continue;
    }
    Float8 bounds;
    bound_children(tree.node(entry.child), search, bounds);
    stack.push_within(bounds, tree.node(entry.child).child, limit());
  }
}

/// Excludes all triangles that intersect the region, except `nearest`, which is excluded already.
SPRUNG_KERNEL void exclude_triangles(const MeshBvh& tree, Index nearest, SafeRegionBuilder& region) {
  Search search = search_around(tree, region.element_box(), region.box());
  update(region, search);
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.child < 0) {
      const TrianglePacket& packet = tree.block(~entry.child);
      unsigned lanes = triangles_in_box(packet, region.box());
      for (int k = 0; k < region.plane_count(); ++k) lanes &= triangles_above(packet, region.normal(k), region.limit(k));
      if (lanes == 0) continue;
      Double4 distances;
      squared_box_distances(packet, region.element_box(), distances);
      while (lanes != 0) {
        const int lane = pop_smallest_lane(distances, lanes);
        if (packet.triangle[lane] != nearest) region.exclude(packet.corners(lane));
      }
      update(region, search);
      continue;
    }
    Float8 bounds;
    bound_children(tree.node(entry.child), search, bounds);
    stack.push_within(bounds, tree.node(entry.child).child, std::numeric_limits<float>::max());
  }
}

/// Finds the nearest triangle within `near` [m]. The search starts with the triangle of the previous search.
void find_nearest(const MeshBvh& tree, const ClosestFeatures& last, double near, const SafeRegion& region,
                  SafeRegionBuilder& builder) {
  if (last.triangle != kNone && box_distance(tree.corners(last.triangle), builder.element_box()) < near) {
    builder.consider(last.triangle, tree.corners(last.triangle), last.features);
  }
  visit_nearest(tree, near, region, builder);
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
  double farthest2 = 0.0;
  visit_blocks(after, box, [&](std::int32_t number) {
    farthest2 = std::max(farthest2, max_deviation(before.block(number), after.block(number), drift));
  });
  return std::sqrt(farthest2);
}

}  // namespace

// The plane of the nearest triangle comes first. It is nearly parallel to the surface, so it excludes most other triangles too.
void find_region(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) {
  const ClosestFeatures last{region.triangle, region.features};
  SafeRegionBuilder builder(element, request, region);
  const double near = std::max(request.exact, std::sqrt(3.0) * request.reach);
  builder.limit_clear_distance(std::max(near, kSearchFactor * request.reach));
  find_nearest(tree, last, near, region, builder);
  if (!builder.grow_to_clear_distance()) {
    const Index nearest = region.triangle;
    if (nearest != kNone) builder.exclude(tree.corners(nearest));
    exclude_triangles(tree, nearest, builder);
  }
  builder.finish();
}

ClosestFeatures closest_features(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request,
                                 const ClosestFeatures& last) {
  SafeRegion found;
  SafeRegionBuilder builder(element, request, found);
  builder.limit_clear_distance(request.exact);
  find_nearest(tree, last, request.exact, found, builder);
  return found.triangle == kNone ? last : ClosestFeatures{found.triangle, found.features};
}

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
