#include "collision/element_bvh/element_pair_filter.h"

#include "base/machine/kernel.h"

#include <limits>

namespace sprung {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

using IntLanes = ElementBvhLeaf::IntLanes;

/// Lanes that a kernel takes by reference need the alignment of the widest instructions that it may use.
struct alignas(kFloatSimdWidth * sizeof(std::int32_t)) RequestedLanes {
  IntLanes lanes;
};

// Lanes are passed by reference: by value, the calling convention would depend on the instruction set.

inline void lower(Float8& a, const Float8& b) { a = a < b ? a : b; }
inline void raise(Float8& a, const Float8& b) { a = a > b ? a : b; }

/// The gap between two bounds along an axis is linear in time, so checking both ends of the interval is enough. Unused lanes are
/// never near: also where coordinates are infinite, as a comparison with what is not a number is false.
inline void keep_bounds_near(const ElementBvhLeaf& a, int lane, const ElementBvhLeaf& b, float now, float end, IntLanes& near) {
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 above = a.min[axis][lane] - b.max[axis];
    const Float8 rising = a.slowest[axis][lane] - b.fastest[axis];
    const Float8 below = b.min[axis] - a.max[axis][lane];
    const Float8 falling = b.slowest[axis] - a.fastest[axis][lane];
    near &= (above + now * rising <= 0.0F) | (above + end * rising <= 0.0F);
    near &= (below + now * falling <= 0.0F) | (below + end * falling <= 0.0F);
  }
}

/// Lanes of b that share a particle with the lane of a; `flat` if the fan around that particle stays flat.
inline void find_sharing(const ElementBvhLeaf& a, int lane, const ElementBvhLeaf& b, IntLanes& shared, IntLanes& flat) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const IntLanes same = b.particle[k] == a.particle[i][lane];
      shared |= same;
      flat |= same & b.flat[k] & a.flat[i][lane];
    }
  }
}

/// Lanes of b whose spheres lie below those of the lane of a along the lane's direction, now and at the end, and so at all times in
/// between.
inline void find_planes_apart(const LeafCorners& a, int lane, const LeafCorners& b, const Float8 (&normal)[3], const Float8& radius,
                              IntLanes& apart) {
  Float8 low_now = Float8{} + kInfinity;
  Float8 low_end = low_now;
  Float8 high_now = -low_now;
  Float8 high_end = high_now;
  for (int k = 0; k < 3; ++k) {
    lower(low_now, normal[0] * a.now[k][0][lane] + normal[1] * a.now[k][1][lane] + normal[2] * a.now[k][2][lane]);
    lower(low_end, normal[0] * a.end[k][0][lane] + normal[1] * a.end[k][1][lane] + normal[2] * a.end[k][2][lane]);
    raise(high_now, normal[0] * b.now[k][0] + normal[1] * b.now[k][1] + normal[2] * b.now[k][2]);
    raise(high_end, normal[0] * b.end[k][0] + normal[1] * b.end[k][1] + normal[2] * b.end[k][2]);
  }
  Float8 gap = low_now - high_now;
  lower(gap, low_end - high_end);
  const Float8 length2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  apart |= (gap > 0.0F) & (gap * gap > radius * radius * length2);
}

/// The line between the centroids of now, times 3.
inline void find_direction(const LeafCorners& a, int lane, const LeafCorners& b, Float8 (&direction)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 middle = b.now[0][axis] + b.now[1][axis] + b.now[2][axis];
    direction[axis] = a.now[0][axis][lane] + a.now[1][axis][lane] + a.now[2][axis][lane] - middle;
  }
}

/// Normals of the triangles, oriented along the direction; their length is twice the area.
inline void find_normals(const Float8 (&x)[3][3], const Float8 (&direction)[3], Float8 (&normal)[3]) {
  Float8 along[2][3];
  for (int axis = 0; axis < 3; ++axis) {
    along[0][axis] = x[1][axis] - x[0][axis];
    along[1][axis] = x[2][axis] - x[0][axis];
  }
  Float8 side = {};
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3;
    const int last = (axis + 2) % 3;
    normal[axis] = along[0][next] * along[1][last] - along[0][last] * along[1][next];
    side += normal[axis] * direction[axis];
  }
  for (int axis = 0; axis < 3; ++axis) normal[axis] = side < 0.0F ? -normal[axis] : normal[axis];
}

/// Sets `hits` to the requested lanes of b that the lane of a may touch. Returns whether there are any.
SPRUNG_KERNEL bool find_touching_lanes(const PositionedLeaf& a, int lane, const PositionedLeaf& b, const RequestedLanes& requested,
                                       float now, float end, LaneBytes& hits) {
  IntLanes near = requested.lanes;
  keep_bounds_near(a.leaf, lane, b.leaf, now, end, near);
  IntLanes apart = ~near;
  IntLanes shared = {};
  find_sharing(a.leaf, lane, b.leaf, shared, apart);
  store(~apart, hits);
  if (!any(hits)) return false;

  const Float8 radius = b.leaf.radius + a.leaf.radius[lane];
  IntLanes kept_apart = {};
  Float8 direction[3];
  find_direction(a.corners, lane, b.corners, direction);
  find_planes_apart(a.corners, lane, b.corners, direction, radius, kept_apart);
  store(~apart & (shared | ~kept_apart), hits);
  if (!any(hits)) return false;

  Float8 normal[3];
  find_normals(b.corners.now, direction, normal);
  find_planes_apart(a.corners, lane, b.corners, normal, radius, kept_apart);
  Float8 own[3][3];
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) own[k][axis] = Float8{} + a.corners.now[k][axis][lane];
  }
  find_normals(own, direction, normal);
  find_planes_apart(a.corners, lane, b.corners, normal, radius, kept_apart);
  store(~apart & (shared | ~kept_apart), hits);
  return any(hits);
}

/// Marked lanes of a that may touch the bounds of b.
LaneBytes marked_lanes_near(const ElementBvhLeaf& a, const ElementBvhLeaf& b, HorizonTimes times) {
  LaneBytes near{};
  if (!a.any_marked()) return near;
  LaneBytes marked;
  store(a.marked, marked);
  find_lanes_near(a, b.bounds, times, 0.0F, near);
  return both(near, marked);
}

}  // namespace

void append_pairs(const PositionedLeaf& first, const PositionedLeaf& second, HorizonTimes times,
                  std::vector<ElementIndexPair>& pairs) {
  const ElementBvhLeaf& a = first.leaf;
  const ElementBvhLeaf& b = second.leaf;
  const bool same = &a == &b;
  const LaneBytes near_a = marked_lanes_near(a, b, times);
  const LaneBytes near_b = same ? LaneBytes{} : marked_lanes_near(b, a, times);
  if (!any(near_a) && !any(near_b)) return;

  const auto now = static_cast<float>(times.now);
  const auto end = static_cast<float>(times.end);
  const auto append = [&](const PositionedLeaf& own, int lane, const PositionedLeaf& other, const RequestedLanes& requested) {
    LaneBytes hits;
    if (!find_touching_lanes(own, lane, other, requested, now, end, hits)) return;
    for (std::size_t k = 0; k < kFloatSimdWidth; ++k) {
      if (hits[k] != 0) pairs.push_back({own.leaf.element[static_cast<std::size_t>(lane)], other.leaf.element[k]});
    }
  };
  constexpr IntLanes kLane{0, 1, 2, 3, 4, 5, 6, 7};
  LaneBytes unmarked_a;
  store(~a.marked, unmarked_a);
  for (int lane = 0; lane < kFloatSimdWidth; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    if (near_a[at] != 0) append(first, lane, second, {same ? (kLane > lane) | ~a.marked : ~IntLanes{}});
    if (near_b[at] != 0 && any(unmarked_a)) append(second, lane, first, {~a.marked});
  }
}

}  // namespace sprung
