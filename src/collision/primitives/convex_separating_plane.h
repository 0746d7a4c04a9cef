// The plane that separates an element of the network from a convex primitive best.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

#include <limits>

namespace sprung {

/// A direction, how far it separates, and the pair of points that gave it.
struct SeparatingPlane {
  Vector3 normal = Vector3::Zero();   ///< unit length, from the shape to the element
  Vector3 point = Vector3::Zero();    ///< on the shape
  Vector3 weights = Vector3::Zero();  ///< of the element's corners, not negative; their sum is 1
  double height = 0.0;                ///< the farthest that the shape reaches along the normal [m]
  double lowest = 0.0;                ///< of the corners along the normal [m]
  int lowest_corner = 0;
  double gap = -std::numeric_limits<double>::infinity();      ///< lowest - height [m], negative when shape and element overlap
  double distance = std::numeric_limits<double>::infinity();  ///< of the pair's points [m], at least the gap
};

/// The least height of a box along `normal` [m].
[[nodiscard]] double lowest(const Box3& box, const Vector3& normal);

/// The best separation of shape and element: nothing of the two is nearer than its gap, which is within 0.2 % of the distance
/// unless they are within rounding of touching, or overlap. Any separation will do once it keeps the shape out of `box`, which
/// holds the element.
///
/// The signed distance of a convex shape is convex, so over an element it is smallest at a corner, within an edge where its slope
/// vanishes, or within the face, where its gradient is the face's normal. Each gives a direction, and the shape's support in that
/// direction proves the gap whatever rounding did to the search. GJK (Gilbert, Johnson and Keerthi 1988) takes its directions from
/// differences of nearly equal points instead, which close to touching are mostly rounding.
[[nodiscard]] SeparatingPlane separation(const SphereGeometry& sphere, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const BoxGeometry& solid, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const CapsuleGeometry& capsule, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const CylinderGeometry& cylinder, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const ConeGeometry& cone, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const Box3& box);
[[nodiscard]] SeparatingPlane separation(const HalfSpaceGeometry& half_space, const ElementCorners& element, const Box3& box);

}  // namespace sprung
