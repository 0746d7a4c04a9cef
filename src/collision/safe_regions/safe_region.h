// Convex free space around an element of the network, in an obstacle's own frame: while each corner of the element stays inside,
// nothing of the element crosses the obstacle, whatever the corners do, because what is convex holds their hull.
#pragma once

#include "collision/core/half_space.h"
#include "geometry/queries/closest_pair.h"

#include <array>
#include <limits>

namespace sprung {

/// The corners of an element in the obstacle's frame.
using ElementCorners = Simplex;

/// What a region is asked to be. All lengths [m], > 0.
struct SafeRegionRequest {
  double reach = 0.0;      ///< the box is that of element and path, this much larger on each side, where the obstacle lets it
  Box3 path{};             ///< where the corners are about to go; empty if nobody knows
  double gap = 0.0;        ///< what contact keeps between element and obstacle: planes stand off by at most half of it
  double clearance = 0.0;  ///< planes stand off at least half of this, above rounding, where the element does by all of it
  double exact = 0.0;      ///< nearest points are to be the true ones where they are nearer than this; may be 0
  bool at_end = false;     ///< the element is where it is at the end of the obstacle's interval; else at its begin
};

/// What the box and the half-spaces have in common holds the element and, at the end of the interval, nothing of the obstacle. A
/// surface that deforms from the interval's begin, where the element is, to its end takes the region along.
struct SafeRegion {
  static constexpr int kMostPlanes = 4;

  Box3 box{};
  std::array<HalfSpace, kMostPlanes> planes{};
  int plane_count = 0;
  double free_radius = std::numeric_limits<double>::infinity();  ///< besides, no corner may move farther than this [m]
  bool broken = false;  ///< element and obstacle touch or cross: there is no such region, nothing is promised

  double clear = 0.0;  ///< nothing of the obstacle was nearer to the element than this [m]

  /// The nearest points of element and obstacle (near enough to them, where farther apart than `exact`), if the obstacle comes that
  /// near or may come within `reach` of an element that stays; else distance is infinite.
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  Vector3 point = Vector3::Zero();                            ///< on the obstacle
  Vector3 normal = Vector3::Zero();                           ///< from it to the element, unit length
  Vector3 weights = Vector3::Zero();                          ///< of the element's corners; their sum is 1
  Index triangle = kNone;                                     ///< of the obstacle; where the next search may begin
  PairPlace place{};                                          ///< of the points, on element and triangle; for that search too

  // Before a surface that deforms:
  double time = std::numeric_limits<double>::quiet_NaN();  ///< end of the interval that the region is for [s]
  Vector3 drift = Vector3::Zero();                         ///< how far the surface at `point` goes in that interval [m]
  double loss = 0.0;                                       ///< what the region lost on each side since it was made [m]
  Vector3 triangle_weights = Vector3::Zero();              ///< of the triangle's corners at `point`; their sum is 1
};

/// The box, smaller by `margin` [m] >= 0 on each side; nothing is in it when the sides pass each other.
[[nodiscard]] Box3 shrunk(const Box3& box, double margin);

/// The box around the element, `reach` [m] larger on each side.
[[nodiscard]] Box3 box_around(const ElementCorners& element, double reach);

/// The largest box that a region may have.
[[nodiscard]] Box3 requested_box(const ElementCorners& element, const SafeRegionRequest& request);

/// How far a plane stands off an obstacle that is `gap` [m] away: the rest is free for the element. Half of the gap that contact
/// keeps is left to contact, and no element is asked to come nearer than it is.
[[nodiscard]] double stand_off(double gap, const SafeRegionRequest& request);

/// Whether the gap [m] is not told from touching, by rounding.
[[nodiscard]] bool is_touching(double gap, const SafeRegionRequest& request);

}  // namespace sprung
