// The motion of a group: the rigid motion of its pins, and planes under an affine motion.
//
// The motion's linear part is interpolated linearly from I to F: A = (1 - t) I + t F. A plane under this motion has the normal
// cof(A) n (Nanson's formula), a quadratic function of time. The height of a point that moves linearly from x0 to x1 above the
// plane is a cubic function of time with the Bernstein coefficients n0 . x0, (2 n1 . x0 + n0 . x1) / 3, (n2 . x0 + 2 n1 . x1) / 3
// and n2 . x1. If each of the four separates two sides, the plane separates them at all times. Sides that follow the motion keep
// det(A) times their gap, for any rotation by less than a right angle.
#pragma once

#include "base/types.h"

#include <optional>
#include <span>

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

/// Positions of a pin at the begin and the end of a step [m].
struct PinDisplacement {
  Vector3 from;
  Vector3 to;
};

/// The rigid motion that fits the pins' displacements best (least squares, Kabsch 1976). Empty if it leaves at least half of
/// the error of their mean translation, because the pins move in parallel or independently, and if it rotates by more than a right
/// angle. Requires at least one pin.
[[nodiscard]] std::optional<RigidTransform> rigid_motion_of(std::span<const PinDisplacement> pins);

}  // namespace sprung
