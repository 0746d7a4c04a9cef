// Rules for the settings of a simulation that is made in code; scene files have theirs in the scene reader, with the places of
// keys.
#pragma once

#include "simulation/simulator.h"

namespace sprung {

/// Throws InputError naming every setting that is not finite, or out of the bounds that its declaration gives. The step is left to
/// `check_step`.
void check_settings(const SimulatorSettings& settings);

}  // namespace sprung
