// Leads bodies that start in obstacles, or across each other, out of them.
#pragma once

#include "collision/obstacles/environment.h"
#include "collision/surface/collision_surface.h"
#include "network/spring_network.h"

namespace sprung {

/// Positions [m] near the `wanted` ones at which no body intersects an obstacle, as they are at the end of the environment's
/// interval, or, if they are to be `apart`, another body. Each body that does is first taken to where it is free: off the surfaces
/// nearby, if it is in obstacles by no more than the size of its elements, else as a whole, to the side where the way out is
/// shortest. Of bodies across each other those leave that no pins hold, and of these the later ones. From there it comes back under
/// the contact of a simulation without forces and friction, through which nothing passes: what is not in the way ends where it is
/// wanted, to the last bit, and the rest at its gap. Pinned particles stay. A body that is nowhere free comes back as it was.
[[nodiscard]] Points push_out(const SpringNetwork& network, Environment& environment, const CollisionSurface& surface,
                              const Points& wanted, bool apart);

}  // namespace sprung
