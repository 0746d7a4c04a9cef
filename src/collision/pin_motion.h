// The motion with which pins take along what hangs on them.
#pragma once

#include "base/types.h"

#include <span>

namespace sprung {

/// Where a pin is when a step begins, and when it ends [m].
struct PinWay {
  Vector3 from;
  Vector3 to;
};

/// The rigid motion that takes pins where they go, with the least squares of what it misses (Kabsch 1976), and turns no more than
/// they ask for: what pins say nothing about, as one of them does about all turns, it leaves. Requires a pin.
[[nodiscard]] RigidTransform common_motion(std::span<const PinWay> pins);

}  // namespace sprung
