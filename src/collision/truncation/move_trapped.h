// Where particles end that obstacles leave no place that they know of beforehand.
#pragma once

#include "collision/truncation/vertex_truncation.h"

namespace sprung {

/// Lets obstacles carry the infeasible ones of these particles from `before` [m], 3 x n, and their neighbours where an element
/// would be crossed otherwise: changes `after` and the outcomes. An obstacle that carries a whole neighbourhood leaves it on the
/// side where it is, whatever its planes lost on the way; whether it did is seen by making the regions where the elements end. What
/// is crossed then stays infeasible.
void move_infeasible(ObstacleSafeRegions& regions, const std::vector<Index>& particles, const Points& before, Points& after,
                     Outcomes& outcomes);

}  // namespace sprung
