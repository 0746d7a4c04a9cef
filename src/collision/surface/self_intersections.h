// What of the network crosses itself.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// Two elements of which an edge of one meets the other, a triangle, without having a particle in common with it.
struct CrossingElements {
  Index first = kNone;
  Index second = kNone;  ///< > first
};

/// All elements that cross among bodies that collide with themselves or each other, ascending. Judged exactly, with the particles
/// at `positions` [m], which are finite. Same result for any number of threads.
[[nodiscard]] std::vector<CrossingElements> find_self_intersections(const CollisionSurface& surface, const Points& positions);

}  // namespace sprung
