#include "collision/element_bvh/element_pair_filter.h"

#include "base/kernel.h"

#include <limits>

namespace sprung {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

using IntLanes = ElementBvhLeaf::IntLanes;

/// Where lanes go to a kernel by reference they are to be aligned for any instructions that it may use.
struct alignas(kFloatSimdWidth * sizeof(std::int32_t)) AskedLanes {
  IntLanes lanes;
};

// Double4 come and go by reference: by value their way would depend on the instructions that are compiled for.

inline void lower(Float8& a, const Float8& b) { a = a < b ? a : b; }
inline void raise(Float8& a, const Float8& b) { a = a > b ? a : b; }

/// What lies between a lane's bounds and those of the other leaf changes linearly along an axis, so both ends of time are enough.
inline void find_bounds_apart(const ElementBvhLeaf& a, int lane, const ElementBvhLeaf& b, float now, float end, IntLanes& apart) {
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 above = a.min[axis][lane] - b.max[axis];
    const Float8 rising = a.slowest[axis][lane] - b.fastest[axis];
    const Float8 below = b.min[axis] - a.max[axis][lane];
    const Float8 falling = b.slowest[axis] - a.fastest[axis][lane];
    apart |= (above + now * rising > 0.0F) & (above + end * rising > 0.0F);
    apart |= (below + now * falling > 0.0F) & (below + end * falling > 0.0F);
  }
}

/// Double4 that share a particle with a lane of the other leaf; `flat` if one whose triangles are flat.
inline void find_sharing(const ElementBvhLeaf& a, int lane, const ElementBvhLeaf& b, IntLanes& shared, IntLanes& flat) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const IntLanes same = b.particle[k] == a.particle[i][lane];
      shared |= same;
      flat |= same & b.flat[k] & a.flat[i][lane];
    }
  }
}

/// Double4 between whose balls there is a gap along the direction, by lane, now and at the end, and so in between: with the lane of
/// the other leaf above, or, where the direction says so, below.
inline void find_planes_apart(const LeafBounds& a, int lane, const LeafBounds& b, const Float8 (&normal)[3], const Float8& radius,
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

/// The line between the middles now.
inline void find_direction(const LeafBounds& a, int lane, const LeafBounds& b, Float8 (&direction)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 middle = b.now[0][axis] + b.now[1][axis] + b.now[2][axis];
    direction[axis] = a.now[0][axis][lane] + a.now[1][axis][lane] + a.now[2][axis][lane] - middle;
  }
}

/// Twice the areas of the triangles, turned to where the direction leads.
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

/// Double4 of b, of those that are asked for, that a lane of a may touch. Returns whether there are any.
SPRUNG_KERNEL bool find_meeting_lanes(const BoundedLeaf& a, int lane, const BoundedLeaf& b, const AskedLanes& asked, float now,
                                      float end, LaneBytes& met) {
  IntLanes apart = ~asked.lanes;
  IntLanes shared = {};
  find_bounds_apart(a.leaf, lane, b.leaf, now, end, apart);
  find_sharing(a.leaf, lane, b.leaf, shared, apart);
  store(~apart, met);
  if (!any(met)) return false;

  const Float8 radius = b.leaf.radius + a.leaf.radius[lane];
  IntLanes kept_apart = {};
  Float8 direction[3];
  find_direction(a.places, lane, b.places, direction);
  find_planes_apart(a.places, lane, b.places, direction, radius, kept_apart);
  store(~apart & (shared | ~kept_apart), met);
  if (!any(met)) return false;

  Float8 normal[3];
  find_normals(b.places.now, direction, normal);
  find_planes_apart(a.places, lane, b.places, normal, radius, kept_apart);
  Float8 own[3][3];
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) own[k][axis] = Float8{} + a.places.now[k][axis][lane];
  }
  find_normals(own, direction, normal);
  find_planes_apart(a.places, lane, b.places, normal, radius, kept_apart);
  store(~apart & (shared | ~kept_apart), met);
  return any(met);
}

/// Marked lanes of a that are not apart from all of b.
LaneBytes marked_lanes_near(const ElementBvhLeaf& a, const ElementBvhLeaf& b, HorizonTimes times) {
  LaneBytes near{};
  if (!a.any_marked()) return near;
  LaneBytes marked;
  store(a.marked, marked);
  find_lanes_near(a, b.bounds, times, 0.0F, near);
  return both(near, marked);
}

}  // namespace

void append_meetings(const BoundedLeaf& first, const BoundedLeaf& second, HorizonTimes times,
                     std::vector<ElementIndexPair>& meetings) {
  const ElementBvhLeaf& a = first.leaf;
  const ElementBvhLeaf& b = second.leaf;
  const bool same = &a == &b;
  const LaneBytes near_a = marked_lanes_near(a, b, times);
  const LaneBytes near_b = same ? LaneBytes{} : marked_lanes_near(b, a, times);
  if (!any(near_a) && !any(near_b)) return;

  const auto now = static_cast<float>(times.now);
  const auto end = static_cast<float>(times.end);
  const auto append = [&](const BoundedLeaf& own, int lane, const BoundedLeaf& other, const AskedLanes& asked) {
    LaneBytes met;
    if (!find_meeting_lanes(own, lane, other, asked, now, end, met)) return;
    for (std::size_t k = 0; k < kFloatSimdWidth; ++k) {
      if (met[k] != 0) meetings.push_back({own.leaf.element[static_cast<std::size_t>(lane)], other.leaf.element[k]});
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
