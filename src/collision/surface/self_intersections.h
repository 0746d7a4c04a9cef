// Intersections of the network with itself.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// Two elements that cross: an edge of one crosses the other, a triangle, and has no particle in common with it.
struct CrossingElements {
  Index first = kNone;
  Index second = kNone;  ///< > first
};

/// All elements that cross among bodies that collide with themselves or each other, ascending. Decided exactly, with the particles
/// at `positions` [m], which must be finite. The result does not depend on the number of threads.
[[nodiscard]] std::vector<CrossingElements> find_self_intersections(const CollisionSurface& surface, const Points& positions);

}  // namespace sprung
