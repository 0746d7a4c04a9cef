// Intersections of the network with itself.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// Two elements with a common point: an edge of one, or a segment or a particle, and the other, which have no particle in common.
struct CrossingElements {
  Index first = kNone;
  Index second = kNone;  ///< > first
};

/// All elements that cross among bodies that collide with themselves or each other, ascending. Not reported are segments with ends
/// that are pinned at one point, as those of ropes that hang from one hook. Decided exactly, with the particles
/// at `positions` [m], which must be finite. The result does not depend on the number of threads.
[[nodiscard]] std::vector<CrossingElements> find_self_intersections(const CollisionSurface& surface, const Points& positions);

}  // namespace sprung
