// The rule for positions that a program writes between two steps.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

namespace sprung {

/// Throws InputError, with a problem for each body and what it meets, if a particle that moves from `before` to `after` [m], 3 x n,
/// passes through an obstacle, or if something intersects at `after` that does not intersect at `before`: bodies and obstacles, and
/// bodies that collide. Sleeping particles count as free. With penalty contact, which lets particles into obstacles, only the
/// elements that begin to intersect count. Requires finite positions, and a frame of the present.
void check_moved(const SpringNetwork& network, const ObstacleFrame& obstacles, const ContactSettings& contact, const Points& before,
                 const Points& after);

}  // namespace sprung
