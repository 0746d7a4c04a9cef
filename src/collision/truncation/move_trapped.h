// Moves trapped particles with the obstacles that close in on them.
#pragma once

#include "collision/truncation/vertex_truncation.h"

namespace sprung {

/// Moves the infeasible ones of these particles with an obstacle, from `before` [m], 3 x n, and their neighbours too if an element
/// would be crossed otherwise. Changes `after` and the outcomes. Particles that move together with one obstacle stay on their side
/// of it, even if the planes of the regions are no longer sharp enough to prove it. So new regions at `after` decide: particles
/// with a crossed element there are infeasible.
void move_infeasible(ObstacleSafeRegions& regions, const ObstacleFrame& obstacles, const std::vector<Index>& particles,
                     const Points& before, Points& after, Outcomes& outcomes);

}  // namespace sprung
