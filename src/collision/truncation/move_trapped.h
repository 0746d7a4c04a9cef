// Where particles end that obstacles leave no place that they know of beforehand.
#pragma once

#include "collision/truncation/vertex_truncation.h"

namespace sprung {

/// Lets obstacles carry the squeezed ones of these particles from `before` [m], 3 x n, and their neighbours where an element would
/// be crossed otherwise: changes `after` and the outcomes. An obstacle that carries a whole neighbourhood leaves it on the side
/// where it is, whatever its planes lost on the way; whether it did is seen by making the zones where the elements end. What is
/// crossed then stays squeezed.
void carry_squeezed(ObstacleZones& zones, const std::vector<Index>& particles, const Points& before, Points& after,
                    Outcomes& outcomes);

}  // namespace sprung
