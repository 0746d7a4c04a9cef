// Whether segments and triangles meet, exactly.
#pragma once

#include "geometry/queries/closest_pair.h"

namespace sprung {

/// Whether the segment from a to b and the triangle (u, v, w) have a point in common: within the triangle's plane too, and touching
/// is enough. The segment may be a point; a triangle without area has no points. Exact: decided by signs of volumes and areas.
[[nodiscard]] bool meets(const Vector3& a, const Vector3& b, const std::array<Vector3, 3>& triangle);

/// Whether the simplex and the triangle have a point in common.
[[nodiscard]] bool meets(const Simplex& simplex, const std::array<Vector3, 3>& triangle);

}  // namespace sprung
