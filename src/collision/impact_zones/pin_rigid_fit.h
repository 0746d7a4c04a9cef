// Rigid fit to the displacements of pins: the motion of a group that hangs on them.
#pragma once

#include "base/types.h"

#include <optional>
#include <span>

namespace sprung {

/// Positions of a pin at the begin and the end of a step [m].
struct PinDisplacement {
  Vector3 from;
  Vector3 to;
};

/// The rigid motion that fits the pins' displacements best (least squares, kabsch_rotation()). Empty if it leaves at least half of
/// the error of their mean translation, because the pins move in parallel or independently, and if it rotates by more than a right
/// angle. Requires at least one pin.
[[nodiscard]] std::optional<RigidTransform> rigid_motion_of(std::span<const PinDisplacement> pins);

}  // namespace sprung
