// Planes that turn while they keep the sides of a pair apart.
//
// While particles go straight from x0 to x1, and a normal from n0 to n1, n . x is for each the quadratic of time with the Bernstein
// coefficients n0 . x0, (n0 . x1 + n1 . x0) / 2 and n1 . x1. Where each of the three keeps the sides apart, a plane does so all the
// time. Where n1 is n0, the second does if the others do.
#pragma once

#include "collision/pairs/contact_stencil.h"

#include <vector>

namespace sprung {

struct RotatingPlane {
  Vector3 begin;  ///< normal where the step begins, unit length
  Vector3 end;    ///< where it ends
};

/// The second coefficient of a particle that goes from x0 to x1 [m].
[[nodiscard]] inline double midway_height(const RotatingPlane& plane, const Vector3& x0, const Vector3& x1) {
  return 0.5 * (plane.begin.dot(x1) + plane.end.dot(x0));
}

/// Begins with the pair's normal, and turns as its particles do on their way from `before` to `ends` [m]. Pinned ones count for
/// most: they give no way.
[[nodiscard]] RotatingPlane turning_plane(const ContactStencil& pair, const Points& before, const Points& ends,
                                          const std::vector<char>& pinned);

}  // namespace sprung
