// The positions at time 0: finds, describes and removes intersections.
#pragma once

#include "base/error.h"
#include "collision/obstacles/obstacle_frame.h"
#include "collision/obstacles/obstacle_intersections.h"
#include "collision/surface/collision_surface.h"
#include "collision/surface/self_intersections.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

/// The rule that a body breaks whose elements intersect each other.
inline const std::string kIntersectsItself = "intersects itself at the start";

struct StartIntersections {
  Intersections with_obstacles;
  std::vector<CrossingElements> with_each_other;

  [[nodiscard]] bool empty() const { return with_obstacles.empty() && with_each_other.empty(); }
};

/// All intersections at `positions` [m] and the end of the frame's interval: of elements and particles with obstacles, except
/// pinned ones, and between elements of bodies that collide with themselves or each other.
[[nodiscard]] StartIntersections find_start_intersections(const ObstacleFrame& obstacles, const CollisionSurface& surface,
                                                          const Points& positions);

/// One problem for each body and obstacle and each pair of bodies: number of intersections, depth [m], positions and remedy.
/// `remedy` applies to all except self-intersections and bodies that a pin holds in an obstacle, which have their own.
[[nodiscard]] std::vector<Problem> start_problems(const StartIntersections& found, const SpringNetwork& network,
                                                  const ObstacleFrame& obstacles, const CollisionSurface& surface,
                                                  const Points& positions, const std::string& remedy);

/// Positions at time 0 [m], and warnings about them. Notes tell what "push_out" moved, as the settings ask.
struct Start {
  Points positions;
  std::vector<std::string> warnings{};
  std::vector<std::string> notes{};
};

/// Returns `positions` [m] if nothing intersects at the end of the frame's interval. With `contact.start` push_out, bodies
/// that intersect are moved by push_out(). Warns about bodies that start deep within their gap to an obstacle. Throws InputError
/// if intersections remain: one problem for each body and obstacle and each pair of bodies, with elements and positions.
[[nodiscard]] Start find_start(const SpringNetwork& network, const ObstacleFrame& obstacles, const ContactSettings& contact,
                               const Points& positions);

}  // namespace sprung
