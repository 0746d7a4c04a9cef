// Support points of convex primitives.
#pragma once

#include "collision/shapes/obstacle.h"

namespace sprung {

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
