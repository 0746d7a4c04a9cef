// Planes under an affine motion.
//
// The motion's linear part is interpolated linearly from I to F: A = (1 - t) I + t F. A plane under this motion has the normal
// cof(A) n (Nanson's formula), a quadratic function of time. The height of a point that moves linearly from x0 to x1 above the
// plane is a cubic function of time with the Bernstein coefficients n0 . x0, (2 n1 . x0 + n0 . x1) / 3, (n2 . x0 + 2 n1 . x1) / 3
// and n2 . x1. If each of the four separates two sides, the plane separates them at all times. Sides that follow the motion keep
// det(A) times their gap, for any rotation by less than a right angle.
#pragma once

#include "base/types.h"

namespace sprung {

/// Bernstein coefficients of the normal; the first has unit length.
struct MovedPlane {
  Vector3 begin;
  Vector3 middle;
  Vector3 end;

  [[nodiscard]] bool is_constant() const { return end == begin; }
};

/// `normal` has unit length and is that of the step's begin; `linear` is F.
[[nodiscard]] MovedPlane moved_plane(const Vector3& normal, const Matrix3& linear);

}  // namespace sprung
