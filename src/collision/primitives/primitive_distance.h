// Signed distances of primitives, exact inside and outside, with the nearest point and a unit normal everywhere.
//
// FCL's distances are not used. Its cone and ellipsoid normals have errors of up to 180 degrees, and it gives no penetration depth
// of a point.
#pragma once

#include "collision/shapes/obstacle.h"
#include "collision/shapes/obstacle_shape.h"

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

}  // namespace sprung
