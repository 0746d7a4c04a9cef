// The positions at time 0.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

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
