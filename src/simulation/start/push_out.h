// Moves bodies that start in obstacles, or across each other, to intersection-free positions.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"
#include "network/model/spring_network.h"

namespace sprung {

/// Positions [m] near `wanted` at which no body intersects an obstacle at the end of the frame's interval or, if `apart`,
/// another body. (1) Each intersecting body moves to a free position: off the nearby surfaces of obstacles if its depth is at most
/// its element size, off the surfaces of other bodies if it crosses them by a little (see lifted_off), otherwise as a whole along
/// the direction of the shortest free displacement. Of two bodies that cross, an unpinned one moves, the later of two; if it cannot
/// be lifted, the other one. (2) From there it approaches `wanted` under contact without forces and friction (see Approach), so
/// particles without obstacles in their path end exactly at `wanted` and the others at their gap. Pinned particles do not move. A
/// body without a free position is returned unchanged.
[[nodiscard]] Points push_out(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface,
                              const Points& wanted, bool apart);

}  // namespace sprung
