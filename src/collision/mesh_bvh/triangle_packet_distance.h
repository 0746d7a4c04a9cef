// Distances of a position from all triangles of a packet at once. For .cpp files of kernels only.
#pragma once

#include "collision/mesh_bvh/triangle_packet.h"
#include "geometry/queries/closest_point_simd.h"

namespace sprung {

/// Squared distances [m^2], one lane per triangle. Each equals the result of closest_point_on_triangle bit for bit.
[[gnu::always_inline]] inline void squared_distances(const Vector3& position, const TrianglePacket& block, Double4& squared) {
  Vector3x4 p;
  set_all_lanes(position, p);
  const auto corner = [&](int k) { return Vector3x4{block.corner[k][0], block.corner[k][1], block.corner[k][2]}; };
  ClosestPointLanes closest;
  unsigned needles = closest_points(p, TriangleLanes{corner(0), corner(1), corner(2)}, closest);
  squared = closest.squared_distance;
  while (needles != 0) {
    const int lane = pop_lane(needles);
    const auto [a, b, c] = block.corners(lane);
    squared[lane] = closest_point_on_triangle(position, a, b, c).squared_distance;
  }
}

}  // namespace sprung
