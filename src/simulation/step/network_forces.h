// The forces that a network and its settings ask for.
#pragma once

#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

namespace sprung {

/// Gravity, springs, angle bends, air and pressure, in the order of their sum. Contact and external forces are not among them. The
/// forces keep references to the network.
[[nodiscard]] Forces network_forces(const SpringNetwork& network, const SimulatorSettings& settings);

}  // namespace sprung
