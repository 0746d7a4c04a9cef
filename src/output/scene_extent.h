// Extent of the scene, for drawing half-spaces.
#pragma once

#include "simulation/simulator.h"

namespace sprung {

/// Bounding box [m] of all particles and all bounded obstacles at the simulator's present time; empty if there are none.
[[nodiscard]] Box3 scene_bounds(const Simulator& simulator);

/// Half the side [m] of the square that represents a half-space's surface: large enough for the scene and its motion.
[[nodiscard]] double half_space_extent(const Box3& scene, const Obstacle& half_space);

}  // namespace sprung
