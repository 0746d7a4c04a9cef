// When attachments engage, and at which points.
#pragma once

#include "collision/obstacles/obstacle_set.h"
#include "dynamics/state/simulation_state.h"

namespace sprung {

struct SpringNetwork;

/// Ends and engages attachments that are due at the state's step, of `step_length` [s]: removes the links of those that end, and
/// adds missing links of those that have begun, from each particle to the nearest second end at the positions of the state. Broken
/// links stay, so that they do not engage again. Returns whether anything changed. Requires that the obstacles exist.
bool update_links(const SpringNetwork& network, const ObstacleSet& obstacles, double step_length, SimulationState& state);

/// The link of an attachment to a body from one of its particles: to the nearest second end at these positions [m], 3 x n. Without
/// its step and lengths.
[[nodiscard]] Link link_to_body(const SpringNetwork& network, const Points& positions, std::size_t attachment, Index particle);

/// Removes the links that the attachments of `network` do not make. `network` replaces `before`.
void drop_unknown_links(const SpringNetwork& before, const SpringNetwork& network, SimulationState& state);

}  // namespace sprung
