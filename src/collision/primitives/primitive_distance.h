// Signed distances of primitives, exact inside and outside, with the nearest point and a normal of unit length everywhere.
//
// FCL's own answers are right for some primitives only (its cone and ellipsoid are off by up to 180 degrees, and none tells how
// deep a point is beyond a touching sphere), so all of them are ours.
#pragma once

#include "collision/shapes/obstacle_shape.h"

namespace sprung {

/// The surface nearest to p. Where several points are (centre, axis, medial planes) one is chosen, always the same.
[[nodiscard]] SurfacePoint surface_point(const SphereGeometry& sphere, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const BoxGeometry& box, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const CapsuleGeometry& capsule, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const CylinderGeometry& cylinder, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const ConeGeometry& cone, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const EllipsoidGeometry& ellipsoid, const Vector3& p);
[[nodiscard]] SurfacePoint surface_point(const HalfSpaceGeometry& half_space, const Vector3& p);

/// Smallest box around the primitive [m]; infinite for a half-space.
[[nodiscard]] Box3 bounds(const SphereGeometry& sphere);
[[nodiscard]] Box3 bounds(const BoxGeometry& box);
[[nodiscard]] Box3 bounds(const CapsuleGeometry& capsule);
[[nodiscard]] Box3 bounds(const CylinderGeometry& cylinder);
[[nodiscard]] Box3 bounds(const ConeGeometry& cone);
[[nodiscard]] Box3 bounds(const EllipsoidGeometry& ellipsoid);
[[nodiscard]] Box3 bounds(const HalfSpaceGeometry& half_space);

}  // namespace sprung
