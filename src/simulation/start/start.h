// Where the network begins.
#pragma once

#include "collision/obstacles/environment.h"
#include "network/spring_network.h"
#include "simulation/settings/simulator_settings.h"

#include <string>
#include <vector>

namespace sprung {

/// Positions at time 0 [m], and what the user should be told of them.
struct Start {
  Points positions;
  std::vector<std::string> warnings{};
};

/// `positions` [m], where nothing intersects at the end of the environment's interval; with `contact.start` push_out those that
/// `push_out` leads to where nothing does. Bodies that begin deep within their gap before an obstacle are warned of. Throws
/// InputError when anything intersects all the same: a line for each body and obstacle, and for each pair of bodies, with what
/// intersects where.
[[nodiscard]] Start find_start(const SpringNetwork& network, Environment& environment, const ContactSettings& contact,
                               const Points& positions);

}  // namespace sprung
