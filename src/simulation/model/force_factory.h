// The forces and constraints that a network and its settings ask for. Nothing else above dynamics/ knows them by type, except for
// who adds one to a simulator.
#pragma once

#include "collision/obstacles/obstacle_set.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/contact/contact_force.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"
#include "simulation/settings/simulator_settings.h"

#include <memory>

namespace sprung {

/// Whether the forces have the dampers of materials (see Body::has_material_dampers).
enum class MaterialDampers : std::uint8_t { within, apart };

// All of these keep references to the network.

/// Gravity, springs, angle bends, air and pressure, in the order of their sum.
[[nodiscard]] Forces network_forces(const SpringNetwork& network, const SimulatorSettings& settings,
                                    MaterialDampers dampers = MaterialDampers::within);

/// The air on faces and lines; null without it.
[[nodiscard]] std::unique_ptr<Force> surface_air(const SpringNetwork& network, const SimulatorSettings& settings);

/// Contact by penalty; null without it. Keeps a reference to the obstacles.
[[nodiscard]] std::unique_ptr<ContactForce> penalty_contact(const SpringNetwork& network, const SimulatorSettings& settings,
                                                            const ObstacleSet& obstacles);

/// Elements that bound the step as this contact does.
[[nodiscard]] std::vector<LinearElement> penalty_elements(const SpringNetwork& network, const SimulatorSettings& settings);

/// Carried surfaces and volumes.
[[nodiscard]] Constraints network_constraints(const SpringNetwork& network);

}  // namespace sprung
