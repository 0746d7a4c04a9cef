// Rules for simulation settings made in code. The scene reader has its own rules, which name the keys of the file.
#pragma once

#include "network/model/attachment.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// Returns the settings. Throws InputError that names every setting that is not finite or is out of its bounds. `check_step` checks
/// the step.
[[nodiscard]] SimulatorSettings checked_settings(SimulatorSettings settings);

/// Warnings about springs that are too weak for the angle bends beside them; the forces of face bends stay bounded. The force of a
/// bend grows as 1 / length, so no step is small enough for a spring that shortens without bound. A bend by a right angle acts with
/// the force k pi / (2 d) on a spring of length d [m]; it may shorten the spring by half at most: k_s d^2 >= pi k.
[[nodiscard]] std::vector<std::string> weak_springs(const SimulatorSettings& settings, const SpringNetwork& network);

/// Warnings about attachments that engaged at less than a hundredth of their rest length: its unit is probably not the metre. That
/// they engage far beyond it is usual, as they pull their ends together.
[[nodiscard]] std::vector<std::string> unlikely_lengths(const SpringNetwork& network, const std::vector<Link>& links);

}  // namespace sprung
