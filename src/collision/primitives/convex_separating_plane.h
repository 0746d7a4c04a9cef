// The best separating plane of an element and a convex primitive.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

#include <limits>

namespace sprung {

/// A separating direction, its gap, and the closest points.
struct SeparatingPlane {
  Vector3 normal = Vector3::Zero();   ///< unit length, from the shape to the element
  Vector3 point = Vector3::Zero();    ///< on the shape
  Vector3 weights = Vector3::Zero();  ///< of the element's corners, not negative; their sum is 1
  double height = 0.0;                ///< largest height of the shape along the normal [m]
  double lowest = 0.0;                ///< smallest height of the corners along the normal [m]
  int lowest_corner = 0;
  double gap = -std::numeric_limits<double>::infinity();      ///< lowest - height [m]; negative if shape and element overlap
  double distance = std::numeric_limits<double>::infinity();  ///< of the closest points [m]; at least the gap
};

/// The smallest height of a box along `normal` [m].
[[nodiscard]] double lowest(const Box3& box, const Vector3& normal);

/// Finds the best separating plane of shape and element. The gap is a lower bound of their distance, within 0.2 % of it, unless
/// they overlap or the distance is within rounding of 0. The search stops early once a plane separates the shape from `box`, which
/// contains the element.
///
/// The signed distance of a convex shape is convex. Its minimum over an element is at a corner, within an edge where its slope
/// vanishes, or within the face where its gradient is the normal of the face. Each candidate gives a direction, and the support
/// point of the shape in this direction proves the gap independently of rounding in the search. GJK (Gilbert, Johnson and Keerthi
/// 1988) takes directions from differences of nearly equal points, which are inaccurate close to contact.
template <class Shape>
[[nodiscard]] SeparatingPlane separation(const Shape& shape, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const HalfSpaceGeometry& half_space, const ElementCorners& element, const Box3& box);

}  // namespace sprung
