// The side of a plane or line on which a point lies, with exact sign.
#pragma once

#include "base/types.h"

namespace sprung {

/// Six times the volume of the tetrahedron (a, b, c, p): positive if p lies on the side to which (b - a) x (c - a) points, exactly
/// zero if the four points are coplanar. The sign is that of exact arithmetic on the coordinates, so neighbouring triangles never
/// disagree about their common edge. The value is accurate to a few ulp of the products. Requires coordinates that are zero or of
/// magnitude 1e-70 to 1e70 (no product of three over- or underflows). Shewchuk 1997: a rounding bound decides most calls, exact
/// expansions the rest.
[[nodiscard]] double side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p);

/// Twice the area of the triangle (a, b, p) in the plane: positive if p lies left of the line from a to b, exactly zero if it lies
/// on the line. As exact as the above.
[[nodiscard]] double side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p);

}  // namespace sprung
