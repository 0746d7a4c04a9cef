// Bodies worn round each other: lifts a body off the surfaces of others that it crosses by a little.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"
#include "network/model/spring_network.h"

#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace sprung {

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
