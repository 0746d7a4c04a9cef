// Signed distances of primitives, exact inside and outside, with the nearest point and a unit normal everywhere, and the best plane
// that separates an element from a convex primitive (convex_separating_plane.cpp).
//
// FCL's distances are not used. Its cone and ellipsoid normals have errors of up to 180 degrees, and it gives no penetration depth
// of a point.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"
#include "collision/shapes/obstacle_shape.h"

#include <limits>

namespace sprung {

/// The point of the surface nearest to p. If several points are nearest (centre, axis, medial planes), the choice is
/// deterministic.
[[nodiscard]] SurfacePoint surface_point(const SphereGeometry& sphere, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const BoxGeometry& box, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const CapsuleGeometry& capsule, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const CylinderGeometry& cylinder, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const ConeGeometry& cone, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const EllipsoidGeometry& ellipsoid, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const HalfSpaceGeometry& half_space, const Vector3& p);

/// The smallest box around the primitive [m]; infinite for a half-space.
[[nodiscard]] Box3 bounds(const SphereGeometry& sphere);
[[nodiscard]] Box3 bounds(const BoxGeometry& box);
[[nodiscard]] Box3 bounds(const CapsuleGeometry& capsule);
[[nodiscard]] Box3 bounds(const CylinderGeometry& cylinder);
[[nodiscard]] Box3 bounds(const ConeGeometry& cone);
[[nodiscard]] Box3 bounds(const EllipsoidGeometry& ellipsoid);
[[nodiscard]] Box3 bounds(const HalfSpaceGeometry& half_space);

/// The point of the shape [m] that is farthest in `direction`, a vector of any length above 0. If several points are farthest, the
/// choice is deterministic. `direction` . point is the maximum over the shape within rounding (van den Bergen 2003, section
/// 4.3.4).
[[nodiscard]] Vector3 support_point(const SphereGeometry& sphere, const Vector3& direction);
[[nodiscard]] Vector3 support_point(const BoxGeometry& box, const Vector3& direction);
[[nodiscard]] Vector3 support_point(const CapsuleGeometry& capsule, const Vector3& direction);
[[nodiscard]] Vector3 support_point(const CylinderGeometry& cylinder, const Vector3& direction);
[[nodiscard]] Vector3 support_point(const ConeGeometry& cone, const Vector3& direction);
[[nodiscard]] Vector3 support_point(const EllipsoidGeometry& ellipsoid, const Vector3& direction);

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
