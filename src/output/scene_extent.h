// The surfaces of obstacles for display and export; a half-space is drawn as a square that the scene fits on.
#pragma once

#include "simulation/simulator.h"

namespace sprung {

/// Bounding box [m] of all particles and all bounded obstacles at the simulator's present time; empty if there are none.
[[nodiscard]] Box3 scene_bounds(const Simulator& simulator);

/// The surface of an obstacle in its own frame [m]. `scene` is scene_bounds(); a half-space is a square that is large enough for
/// the scene and its motion.
[[nodiscard]] TriangleMesh surface_mesh(const Obstacle& obstacle, const Box3& scene);

}  // namespace sprung
