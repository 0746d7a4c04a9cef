// The motion with which pins take along what hangs on them.
#pragma once

#include "base/types.h"

#include <optional>
#include <span>

namespace sprung {

/// Where a pin is when a step begins, and when it ends [m].
struct PinDisplacement {
  Vector3 from;
  Vector3 to;
};

/// The rigid motion that takes pins where they go, with the least squares of what it misses, turned by kabsch_rotation(). None
/// where they go the same way or ways of their own: where it misses half of what their mean motion does or more, or turns by more
/// than a right angle. Requires a pin.
[[nodiscard]] std::optional<RigidTransform> common_turn(std::span<const PinDisplacement> pins);

}  // namespace sprung
