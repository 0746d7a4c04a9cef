// Rules for simulation settings made in code. The scene reader has its own rules, which name the keys of the file.
#pragma once

#include "collision/shapes/obstacle.h"
#include "network/model/attachment.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

class ProblemList;
struct SpringNetwork;

/// Returns the settings. Throws InputError that names every setting that is not finite or is out of its bounds. `check_step` checks
/// the step.
[[nodiscard]] SimulatorSettings checked_settings(SimulatorSettings settings);

/// Adds a problem for each number of a wind that is not finite or out of its bounds, and for keyframes that are not sorted.
void check_wind(const Wind& wind, ProblemList& problems);

/// Warnings about springs that are too weak for the angle bends beside them; the forces of face bends stay bounded. The force of a
/// bend grows as 1 / length, so no step is small enough for a spring that shortens without bound. A bend by a right angle acts with
/// the force k pi / (2 d) on a spring of length d [m]; it may shorten the spring by half at most: k_s d^2 >= pi k.
[[nodiscard]] std::vector<std::string> weak_springs(const SimulatorSettings& settings, const SpringNetwork& network);

/// Warnings about attachments that engaged at less than a hundredth of their rest length: its unit is probably not the metre. That
/// they engage far beyond it is usual, as they pull their ends together.
[[nodiscard]] std::vector<std::string> unlikely_lengths(const SpringNetwork& network, const std::vector<Link>& links);

/// Warnings about settings without effect on this network and these obstacles: a stretch limit of kinds that no spring has,
/// springs that it leaves out because they yield or break, tethers without pins, wind and gusts on bodies without drag, drag of
/// surfaces without faces or coefficients, penalty contact without thickness and what it ignores, and friction whose partners have
/// none.
[[nodiscard]] std::vector<std::string> unused_settings(const SimulatorSettings& settings, const SpringNetwork& network,
                                                       const std::vector<Obstacle>& obstacles);

}  // namespace sprung
