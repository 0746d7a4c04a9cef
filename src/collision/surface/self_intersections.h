// Intersections of the network with itself.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// Two elements that intersect: an edge, a segment or a particle of one has a point in common with the other. They share no
/// particle.
struct CrossingElements {
  Index first = kNone;
  Index second = kNone;  ///< > first
};

/// All elements that cross among bodies that collide with themselves or each other, ascending. Segments with ends that are pinned
/// at one point, as those of ropes that hang from one hook, are not reported. Decided exactly, with the particles at `positions`
/// [m], which must be finite. The result does not depend on the number of threads.
[[nodiscard]] std::vector<CrossingElements> find_self_intersections(const CollisionSurface& surface, const Points& positions);

}  // namespace sprung
