// Rotating planes between the sides of a stencil.
//
// If a particle moves linearly from x0 to x1 and the normal changes linearly from n0 to n1, the height n . x is a quadratic
// function of time with the Bernstein coefficients n0 . x0, (n0 . x1 + n1 . x0) / 2 and n1 . x1. If each of the three separates the
// sides, the plane separates them at all times. For n1 = n0 the second follows from the other two.
#pragma once

#include "collision/pairs/contact_stencil.h"
#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

struct RotatingPlane {
  Vector3 begin;  ///< normal at the step's begin, unit length
  Vector3 end;    ///< normal at the step's end
};

/// The second Bernstein coefficient of a particle that moves from x0 to x1 [m].
[[nodiscard]] inline double midway_height(const RotatingPlane& plane, const Vector3& x0, const Vector3& x1) {
  return 0.5 * (plane.begin.dot(x1) + plane.end.dot(x0));
}

/// Begins with the pair's normal and rotates with its particles from `before` to `ends` [m]. Fixed particles dominate the
/// rotation, because they cannot yield.
[[nodiscard]] RotatingPlane rotating_plane(const ContactStencil& pair, const Points& before, const Points& ends,
                                           const ParticleMotions& motions);

}  // namespace sprung
