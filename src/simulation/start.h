// Where the network begins.
#pragma once

#include "collision/environment.h"
#include "network/spring_network.h"
#include "simulation/simulator.h"

namespace sprung {

/// Throws InputError when anything intersects at the end of the environment's interval, with the particles at `positions` [m]: a
/// line for each body and obstacle, and for each pair of bodies, with what intersects where.
void refuse_intersections(const SpringNetwork& network, const Environment& environment, const ContactSettings& contact,
                          const Points& positions);

}  // namespace sprung
