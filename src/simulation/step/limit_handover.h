// Which bodies' stretch limit a global solve takes over from passes, by what those leave of it.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/simulation_state.h"

namespace sprung {

/// What an impact leaves too long passes take back within fewer steps, and by then steps are made in their smallest parts.
inline constexpr int kMostMissedSteps = 16;

/// Hands each body over, for good, that may be and whose springs passes have left longer than wanted (see wanted_excess) after
/// kMostMissedSteps steps in a row. `excess` is the largest in the step that is done.
void hand_over_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state);

}  // namespace sprung
