// Moves bodies that start in obstacles, or across each other, to intersection-free positions.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"
#include "network/model/spring_network.h"

#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace sprung {

/// Positions [m] near `wanted` at which no body intersects an obstacle at the end of the frame's interval or, if `apart`,
/// another body. (1) Each intersecting body moves to a free position: off the nearby surfaces of obstacles if its depth is at most
/// its element size, off the surfaces of other bodies if it crosses them by a little (see lifted_off), otherwise as a whole along
/// the direction of the shortest free displacement. Of two bodies that cross, an unpinned one moves, the later of two; if it cannot
/// be lifted, the other one. (2) From there it approaches `wanted` under contact without forces and friction (class Approach), so
/// particles without obstacles in their path end exactly at `wanted` and the others at their gap. Pinned particles do not move. A
/// body without a free position is returned unchanged.
[[nodiscard]] Points push_out(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface,
                              const Points& wanted, bool apart);

// Of layers.cpp.

/// Numbers of two bodies, or twice that of one, ascending.
using BodyPair = std::pair<Index, Index>;

/// The bodies that cross each other or themselves at `positions` [m].
[[nodiscard]] std::set<BodyPair> crossing_bodies(const CollisionSurface& surface, const Points& positions);

/// `wanted` [m] with particles of the body lifted to one side of the surfaces of the bodies `below` that it crosses, so that it
/// crosses neither those nor itself nor an obstacle. Of the two sides of a surface, the one that needs the shorter displacement.
/// Fails if the bodies cross too deeply or too steeply. Pinned particles do not move.
[[nodiscard]] std::optional<Points> lifted_off(const SpringNetwork& network, const ObstacleFrame& obstacles,
                                               const CollisionSurface& surface, Index body, const std::vector<Index>& below,
                                               const Points& wanted);

}  // namespace sprung
