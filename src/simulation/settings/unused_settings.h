// Settings that do nothing.
#pragma once

#include "collision/shapes/obstacle.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// Warnings about settings without effect on this network and these obstacles: a stretch limit of kinds that no spring has,
/// springs that it leaves out because they yield or break, tethers without pins, wind and gusts on bodies without drag, drag of
/// surfaces without faces or coefficients, penalty contact without thickness and what it ignores, and friction whose partners have
/// none.
[[nodiscard]] std::vector<std::string> unused_settings(const SimulatorSettings& settings, const SpringNetwork& network,
                                                       const std::vector<Obstacle>& obstacles);

}  // namespace sprung
