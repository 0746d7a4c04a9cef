// The collision surface of a network.
#pragma once

#include "collision/surface/collision_surface.h"
#include "network/model/spring_network.h"

namespace sprung {

/// The triangles and segments of each body's surface, and each particle that is in none of them as an element of its own.
/// Particles inside a solid are elements too, so that an obstacle cannot separate them from their body.
[[nodiscard]] CollisionSurface contact_surface(const SpringNetwork& network);

/// The present motion of each particle: driven by a pin that moves; at rest if it sleeps or its pin stands still; else free.
[[nodiscard]] ParticleMotions particle_motions(const SpringNetwork& network);

}  // namespace sprung
