// Rules for the settings of a simulation that is made in code; scene files have theirs in the scene reader, with the places of
// keys.
#pragma once

#include "simulation/simulator.h"

#include <string>
#include <vector>

namespace sprung {

/// Returns the settings. Throws InputError naming every one that is not finite, or out of the bounds that its declaration gives.
/// The step is left to `check_step`.
[[nodiscard]] SimulatorSettings checked_settings(SimulatorSettings settings);

/// What the user should be told of settings that do nothing for this network: a stretch limit of kinds that no spring has.
[[nodiscard]] std::vector<std::string> idle_settings(const SimulatorSettings& settings, const SpringNetwork& network);

}  // namespace sprung
