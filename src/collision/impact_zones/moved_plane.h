// Planes that an affine motion takes along.
//
// While the motion's linear part goes straight from I to F, A = (1 - t) I + t F, a plane that goes along keeps the normal cof(A) n,
// a quadratic of time. Where x goes straight from x0 to x1, the height of x above it is a cubic with the Bernstein coefficients
// n0 . x0, (2 n1 . x0 + n0 . x1) / 3, (n2 . x0 + 2 n1 . x1) / 3 and n2 . x1. Where each of the four keeps two sides apart, the
// plane does so all the time. What goes along as well is kept apart by det(A) times the gap, whatever the angle below a right one.
#pragma once

#include "base/types.h"

namespace sprung {

/// Bernstein coefficients of the normal; the first has unit length.
struct MovedPlane {
  Vector3 begin;
  Vector3 middle;
  Vector3 end;

  [[nodiscard]] bool stays() const { return end == begin; }
};

/// With `normal`, unit length, where the step begins; `linear` is F.
[[nodiscard]] MovedPlane moved_plane(const Vector3& normal, const Matrix3& linear);

}  // namespace sprung
