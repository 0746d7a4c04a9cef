// What intersects where the network begins.
#pragma once

#include "base/error.h"
#include "collision/obstacles/environment.h"
#include "collision/obstacles/obstacle_intersections.h"
#include "collision/surface/collision_surface.h"
#include "collision/surface/self_intersections.h"
#include "network/spring_network.h"

#include <string>
#include <vector>

namespace sprung {

struct StartIntersections {
  Intersections with_obstacles;
  std::vector<CrossingElements> with_each_other;

  [[nodiscard]] bool empty() const { return with_obstacles.empty() && with_each_other.empty(); }
};

/// All that intersects at the end of the environment's interval, with the particles at `positions` [m]: elements and particles with
/// obstacles, but for what pins hold there, and elements of bodies that collide with themselves or each other.
[[nodiscard]] StartIntersections find_start_intersections(const Environment& environment, const CollisionSurface& surface,
                                                          const Points& positions);

/// A line for each body and obstacle, and for each pair of bodies: how much intersects, how deep, where, and the remedy: for what
/// intersects anything but itself, `remedy`.
[[nodiscard]] std::vector<Problem> start_problems(const StartIntersections& found, const SpringNetwork& network,
                                                  const Environment& environment, const CollisionSurface& surface,
                                                  const Points& positions, const std::string& remedy);

}  // namespace sprung
