// What of the network is where it cannot be: in obstacles or across their surfaces.
#pragma once

#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

class ObstacleSet;

struct Intersections {
  /// A particle inside a closed obstacle.
  struct Inside {
    Index particle = kNone;
    Index obstacle = kNone;
    double depth = 0.0;  ///< from the nearest surface [m]
  };
  /// An element that crosses the surface of an obstacle or touches it to rounding.
  struct Crossing {
    Index element = kNone;
    Index obstacle = kNone;
  };

  std::vector<Inside> inside;       ///< ascending
  std::vector<Crossing> crossings;  ///< ascending

  [[nodiscard]] bool empty() const { return inside.empty() && crossings.empty(); }
};

/// What is in the obstacles at the end of their interval, with the particles at `positions` [m], which are finite. Crossings of
/// meshes and insides are judged exactly, touching by 2^-40 of the coordinates: where nothing is found, all elements have a region.
/// Left out is what pins hold in place: pinned particles, elements of pinned particles alone, and elements that hang from a pin
/// which is in or on the obstacle itself. With `body` only that one is looked at. Same result for any number of threads.
[[nodiscard]] Intersections find_intersections(const ObstacleSet& obstacles, const CollisionSurface& surface,
                                               const Points& positions, Index body = kNone);

}  // namespace sprung
