// The forces that a network and its settings ask for.
#pragma once

#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

namespace sprung {

/// Whether the forces have the dampers of materials (see Body::has_material_dampers).
enum class MaterialDampers : std::uint8_t { within, apart };

/// Gravity, springs, angle bends, air and pressure, in the order of their sum. Contact and external forces are not among them. The
/// forces keep references to the network.
[[nodiscard]] Forces network_forces(const SpringNetwork& network, const SimulatorSettings& settings,
                                    MaterialDampers dampers = MaterialDampers::within);

}  // namespace sprung
