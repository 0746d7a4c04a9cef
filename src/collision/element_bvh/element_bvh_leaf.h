// Leaf of the element BVH: eight elements in single precision.
#pragma once

#include "base/machine/simd.h"
#include "collision/element_bvh/vertex_bounds.h"
#include "collision/surface/collision_surface.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sprung {

/// At time t the bounds are min + t slowest and max + t fastest. Lanes are x, y, z and one that is always 0.
struct KineticAabb {
  using Axes = float __attribute__((vector_size(4 * sizeof(float))));

  Axes min{};
  Axes max{};
  Axes slowest{};
  Axes fastest{};
};

inline void extend(KineticAabb& bounds, const KineticAabb& other) {
  bounds.min = other.min < bounds.min ? other.min : bounds.min;
  bounds.max = other.max > bounds.max ? other.max : bounds.max;
  bounds.slowest = other.slowest < bounds.slowest ? other.slowest : bounds.slowest;
  bounds.fastest = other.fastest > bounds.fastest ? other.fastest : bounds.fastest;
}

/// Whether some axis keeps more than `margin` >= 0 between the bounds from `now` to `end`. The gap is linear in time, so checking
/// both times is enough.
[[nodiscard]] inline bool are_apart(const KineticAabb& a, const KineticAabb& b, float now, float end, float margin) {
  const KineticAabb::Axes above = a.min - b.max;
  const KineticAabb::Axes rising = a.slowest - b.fastest;
  const KineticAabb::Axes below = b.min - a.max;
  const KineticAabb::Axes falling = b.slowest - a.fastest;
  const auto apart = ((above + now * rising > margin) & (above + end * rising > margin)) |
                     ((below + now * falling > margin) & (below + end * falling > margin));
  return (apart[0] | apart[1] | apart[2]) != 0;
}

/// An interval of time [steps]. The spheres' centers are given for `now`.
struct HorizonTimes {
  double now = 0.0;
  double end = 0.0;
};

/// Up to eight elements of one body, a lane each; unused lanes have empty bounds. Coordinates are relative to an origin near the
/// bodies' initial positions. At time t the spheres of an element's particles lie between min + t slowest and max + t fastest.
struct alignas(64) ElementBvhLeaf {
  using IntLanes = std::int32_t __attribute__((vector_size(kFloatSimdWidth * sizeof(std::int32_t))));

  Float8 min[3];
  Float8 max[3];
  Float8 slowest[3];
  Float8 fastest[3];
  KineticAabb bounds;         ///< of all lanes
  KineticAabb marked_bounds;  ///< of the marked lanes; not set if none is marked
  Float8 corner[3][3];        ///< by corner and axis, at time 0; smaller elements repeat their first corner
  Float8 motion[3][3];        ///< by corner and axis [m per step]
  Float8 radius;              ///< of the largest sphere, plus a bound of rounding
  IntLanes particle[3];       ///< by corner
  IntLanes flat[3];      ///< by corner: -1 for triangles whose fan around the particle stays flat, see fan_stays_flat(); else 0
  IntLanes marked;       ///< -1 or 0
  IntLanes is_triangle;  ///< -1 or 0
  std::array<Index, kFloatSimdWidth> element;
  int count;  ///< of the lanes used

  ElementBvhLeaf();

  /// Sets the lane to an element and bounds it from time 0 to the end. Requires the same origin [m] for all leaves and times.
  void set(int lane, Index number, const Element& element, const VertexBounds& spheres, const Vector3& origin,
           const std::vector<char>& is_flat, HorizonTimes times);

  /// Sets the bounds of all lanes.
  void bound();

  /// Sets the bounds of the marked lanes.
  void bound_marked();

  [[nodiscard]] KineticAabb lane_bounds(int lane) const {
    using Axes = KineticAabb::Axes;
    return {Axes{min[0][lane], min[1][lane], min[2][lane]}, Axes{max[0][lane], max[1][lane], max[2][lane]},
            Axes{slowest[0][lane], slowest[1][lane], slowest[2][lane]}, Axes{fastest[0][lane], fastest[1][lane], fastest[2][lane]}};
  }

  [[nodiscard]] bool any_marked() const;
};

template <Same<KineticAabb> S, class Visit>
void visit_members(S& b, const Visit& visit) {
  visit(b.min, b.max, b.slowest, b.fastest);
}
/// Without the marks, which each search makes anew, and the elements, which never change.
template <Same<ElementBvhLeaf> S, class Visit>
void visit_members(S& l, const Visit& visit) {
  visit(l.min, l.max, l.slowest, l.fastest, l.bounds, l.corner, l.motion, l.radius, l.particle, l.flat, l.is_triangle);
}

/// Positions of the corners of a leaf's elements, now and at the end of the interval.
struct alignas(64) LeafCorners {
  Float8 now[3][3];  ///< by corner and axis
  Float8 end[3][3];
};

void find_corners(const ElementBvhLeaf& leaf, HorizonTimes times, LeafCorners& corners);

/// 255 or 0 by lane.
using LaneBytes = std::array<std::uint8_t, kFloatSimdWidth>;

inline void store(const ElementBvhLeaf::IntLanes& lanes, LaneBytes& mask) {
  using Bytes = std::uint8_t __attribute__((vector_size(kFloatSimdWidth)));
  const Bytes bytes = __builtin_convertvector(lanes, Bytes);
  __builtin_memcpy(mask.data(), &bytes, sizeof bytes);
}

[[nodiscard]] inline LaneBytes both(const LaneBytes& a, const LaneBytes& b) {
  LaneBytes result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = static_cast<std::uint8_t>(a[k] & b[k]);
  return result;
}
[[nodiscard]] inline LaneBytes either(const LaneBytes& a, const LaneBytes& b) {
  LaneBytes result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = static_cast<std::uint8_t>(a[k] | b[k]);
  return result;
}

/// Sets `near` to the lanes that may come within `margin` >= 0 [m] of the bounds.
void find_lanes_near(const ElementBvhLeaf& leaf, const KineticAabb& bounds, HorizonTimes times, float margin, LaneBytes& near);

[[nodiscard]] inline bool any(const LaneBytes& mask) {
  std::uint64_t all = 0;
  __builtin_memcpy(&all, mask.data(), sizeof all);
  return all != 0;
}

}  // namespace sprung
