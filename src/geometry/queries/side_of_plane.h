// The side of a plane or line that a point lies on, with its exact sign.
#pragma once

#include "base/types.h"

namespace sprung {

/// Six times the volume of the tetrahedron (a, b, c, p): positive when p lies on the side that (b - a) x (c - a) points to, exactly
/// zero when the four points are in one plane. The sign is that of exact arithmetic on the coordinates as they are, so neighbouring
/// triangles never disagree about their common edge; the value is right to a few ulp of the products. Requires coordinates that are
/// zero or between 1e-70 and 1e70 (no product of three over- or underflows). Shewchuk 1997: a rounding bound decides most calls,
/// exact expansions the rest.
[[nodiscard]] double side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p);

/// Twice the area of the triangle (a, b, p) in the plane: positive when p lies left of the line from a to b, exactly zero when it
/// lies on it. As exact as the above.
[[nodiscard]] double side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p);

}  // namespace sprung
