// Hands bodies whose stretch limit the Gauss-Seidel passes keep missing over to a global solve.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/simulation_state.h"

namespace sprung {

/// Passes remove the excess of an impact in fewer steps than this, and substeps have reached their smallest length by then.
inline constexpr int kMaxMissedSteps = 16;

/// Hands over, permanently, each eligible body whose excess was larger than wanted_excess() after kMaxMissedSteps steps in a row.
/// `excess` is the largest excess of all bodies after the present step [fraction of the rest length].
void hand_over_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state);

}  // namespace sprung
