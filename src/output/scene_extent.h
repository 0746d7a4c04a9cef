// How large the scene is, for drawing what has no end.
#pragma once

#include "simulation/simulator.h"

namespace sprung {

/// Smallest box around all particles and all obstacles with an end, at the simulator's present time [m]; empty when there are none.
[[nodiscard]] Box3 scene_bounds(const Simulator& simulator);

/// Half the side [m] of a square around the middle of a half-space's surface that the whole scene fits over, with room to move.
[[nodiscard]] double half_space_extent(const Box3& scene, const Obstacle& half_space);

}  // namespace sprung
