// Finds intersections of bodies with obstacles.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

class ObstacleFrame;

struct Intersections {
  /// A particle inside a closed obstacle.
  struct Inside {
    Index particle = kNone;
    Index obstacle = kNone;
    double depth = 0.0;  ///< distance from the nearest surface point [m]
  };
  /// An element that crosses or touches the surface of an obstacle.
  struct Crossing {
    Index element = kNone;
    Index obstacle = kNone;
  };

  std::vector<Inside> inside;       ///< in ascending order
  std::vector<Crossing> crossings;  ///< in ascending order

  [[nodiscard]] bool empty() const { return inside.empty() && crossings.empty(); }
};

/// Finds all intersections at the end of the frame's interval. `positions` [m] must be finite. Crossings of meshes and
/// particles inside are decided exactly, touching with a tolerance of 2^-40 of the coordinates. If the result is empty, every
/// element has a safe region. Not reported are fixed particles, elements with only fixed particles, and elements with a fixed
/// particle in or on the same obstacle. `body` limits the search to one body. The result does not depend on the number of threads.
[[nodiscard]] Intersections find_intersections(const ObstacleFrame& frame, const CollisionSurface& surface, const Points& positions,
                                               Index body = kNone);

}  // namespace sprung
