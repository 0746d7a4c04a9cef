// Exact intersection tests of segments and triangles.
#pragma once

#include "geometry/queries/closest_pair.h"

namespace sprung {

/// Whether the segment from a to b and the triangle (u, v, w) have a common point. Coplanar and touching pairs count. The segment
/// may be a point; a triangle without area has no points. Exact: decided by the signs of volumes and areas.
[[nodiscard]] bool intersects(const Vector3& a, const Vector3& b, const std::array<Vector3, 3>& triangle);

/// Whether the segments from a to b and from c to d have a common point. They may be points.
[[nodiscard]] bool intersects(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Whether the simplex and the triangle have a common point.
[[nodiscard]] bool intersects(const Simplex& simplex, const std::array<Vector3, 3>& triangle);

}  // namespace sprung
