// The network as contact sees it.
#pragma once

#include "collision/surface/collision_surface.h"
#include "network/spring_network.h"

namespace sprung {

/// The triangles and segments of each body's surface, and each particle that neither has as an element of its own: those inside a
/// solid too, which so cannot be left behind in an obstacle.
[[nodiscard]] CollisionSurface contact_surface(const SpringNetwork& network);

}  // namespace sprung
