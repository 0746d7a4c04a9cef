// Distances of a position from the triangles of a block, all at once. For the .cpp files of kernels.
#pragma once

#include "collision/triangle_block.h"
#include "geometry/closest_point.h"

namespace sprung {

namespace detail {

struct LaneVector {
  BlockLanes x;
  BlockLanes y;
  BlockLanes z;
};

[[gnu::always_inline]] inline void subtract(const LaneVector& a, const LaneVector& b, LaneVector& to) {
  to.x = a.x - b.x;
  to.y = a.y - b.y;
  to.z = a.z - b.z;
}

[[gnu::always_inline]] inline void dot(const LaneVector& a, const LaneVector& b, BlockLanes& to) {
  to = a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The nearest point: base + (s along + t ac) / divisor.
struct Foot {
  LaneVector base;
  LaneVector along;
  BlockLanes s;
  BlockLanes t;
  BlockLanes divisor;
  BlockMask on_face;
};

/// Puts the foot on an edge or a vertex in some lanes.
[[gnu::always_inline]] inline void put(const BlockMask& where, const LaneVector& base, const LaneVector& along, const BlockLanes& s,
                                       const BlockLanes& t, const BlockLanes& divisor, Foot& foot) {
  foot.base.x = where ? base.x : foot.base.x;
  foot.base.y = where ? base.y : foot.base.y;
  foot.base.z = where ? base.z : foot.base.z;
  foot.along.x = where ? along.x : foot.along.x;
  foot.along.y = where ? along.y : foot.along.y;
  foot.along.z = where ? along.z : foot.along.z;
  foot.s = where ? s : foot.s;
  foot.t = where ? t : foot.t;
  foot.divisor = where ? divisor : foot.divisor;
  foot.on_face &= ~where;
}

}  // namespace detail

/// Squared distances [m^2], a lane a triangle, each to the last bit that of closest_point_on_triangle. The cases are the same, but
/// what that function asks first is put last here, over all others.
[[gnu::always_inline]] inline void squared_distances(const Vector3& position, const TriangleBlock& block, BlockLanes& squared) {
  using detail::LaneVector;
  const BlockLanes zero{};
  const BlockLanes one = zero + 1.0;
  const LaneVector p{zero + position[0], zero + position[1], zero + position[2]};
  const LaneVector a{block.corner[0][0], block.corner[0][1], block.corner[0][2]};
  const LaneVector b{block.corner[1][0], block.corner[1][1], block.corner[1][2]};
  const LaneVector c{block.corner[2][0], block.corner[2][1], block.corner[2][2]};
  LaneVector ab, ac, bc, ap, bp, cp;
  detail::subtract(b, a, ab);
  detail::subtract(c, a, ac);
  detail::subtract(c, b, bc);
  detail::subtract(p, a, ap);
  detail::subtract(p, b, bp);
  detail::subtract(p, c, cp);
  BlockLanes d1, d2, d3, d4, d5, d6, ab2, ac2;
  detail::dot(ab, ap, d1);
  detail::dot(ac, ap, d2);
  detail::dot(ab, bp, d3);
  detail::dot(ac, bp, d4);
  detail::dot(ab, cp, d5);
  detail::dot(ac, cp, d6);
  detail::dot(ab, ab, ab2);
  detail::dot(ac, ac, ac2);
  const BlockLanes va = d3 * d6 - d5 * d4;
  const BlockLanes vb = d5 * d2 - d1 * d6;
  const BlockLanes vc = d1 * d4 - d3 * d2;
  const BlockLanes area2 = va + vb + vc;
  const BlockLanes along_bc = d4 - d3;
  const BlockLanes along_cb = d5 - d6;

  detail::Foot foot{a, ab, vb, vc, area2, zero == zero};
  detail::put((va <= zero) & (along_bc >= zero) & (along_cb >= zero) & (along_bc + along_cb > zero), b, bc, along_bc, zero,
              along_bc + along_cb, foot);
  detail::put((vb <= zero) & (d2 >= zero) & (d6 <= zero) & (d2 > d6), a, ab, zero, d2, d2 - d6, foot);
  detail::put((d6 >= zero) & (d5 <= d6), c, ab, zero, zero, one, foot);
  detail::put((vc <= zero) & (d1 >= zero) & (d3 <= zero) & (d1 > d3), a, ab, d1, zero, d1 - d3, foot);
  detail::put((d3 >= zero) & (d4 <= d3), b, ab, zero, zero, one, foot);
  detail::put((d1 <= zero) & (d2 <= zero), a, ab, zero, zero, one, foot);

  const BlockLanes s = foot.s / foot.divisor;
  const BlockLanes t = foot.t / foot.divisor;
  const LaneVector away{p.x - (foot.base.x + s * foot.along.x + t * ac.x), p.y - (foot.base.y + s * foot.along.y + t * ac.y),
                        p.z - (foot.base.z + s * foot.along.z + t * ac.z)};
  detail::dot(away, away, squared);

  for (unsigned needles = lanes_that_hold(foot.on_face & ~(area2 > 1e-10 * ab2 * ac2)); needles != 0;) {
    const int lane = take_lane(needles);
    const auto [u, v, w] = block.corners(lane);
    squared[lane] = closest_point_on_triangle(position, u, v, w).squared_distance;
  }
}

}  // namespace sprung
