// Moves trapped particles with the obstacles that close in on them.
#pragma once

#include "collision/truncation/vertex_truncation.h"

namespace sprung {

/// Moves the infeasible ones of these particles with an obstacle, from `before` [m], 3 x n, and their neighbours too where an
/// element would be crossed otherwise. Changes `after` and the outcomes. A neighbourhood that moves with one obstacle as a whole
/// stays on its side of it, even if the regions' planes lost too much on the way to show it: new regions at `after` decide.
/// Particles whose elements are crossed there are infeasible.
void move_infeasible(ObstacleSafeRegions& regions, const std::vector<Index>& particles, const Points& before, Points& after,
                     Outcomes& outcomes);

}  // namespace sprung
