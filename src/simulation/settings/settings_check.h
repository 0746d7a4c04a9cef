// Rules for the settings of a simulation that is made in code; scene files have theirs in the scene reader, with the places of
// keys.
#pragma once

#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

/// Returns the settings. Throws InputError naming every one that is not finite, or out of the bounds that its declaration gives.
/// The step is left to `check_step`.
[[nodiscard]] SimulatorSettings checked_settings(SimulatorSettings settings);

/// What the user should be told of settings that do nothing for this network: a stretch limit of kinds that no spring has, wind
/// without drag.
[[nodiscard]] std::vector<std::string> idle_settings(const SimulatorSettings& settings, const SpringNetwork& network);

/// What the user should be told of angle bends whose bonds give way before them: the pull of a bend goes with 1 / length, beyond
/// all that a step can be chosen for. A bend by a right angle, which pushes with k pi / 2 over the bond's length d, is to shorten
/// it by half at most, if nothing else holds it: k_s d^2 >= pi k.
[[nodiscard]] std::vector<std::string> weak_bonds(const SimulatorSettings& settings, const SpringNetwork& network);

}  // namespace sprung
