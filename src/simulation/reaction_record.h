// The impulses of pins and attachments since the last reading.
#pragma once

#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"
#include "simulation/reaction.h"
#include "simulation/settings/simulator_settings.h"

#include <vector>

namespace sprung {

// A step records impulses by particle; before pins begin or end they are added up by pin. A pinned particle of mass m gains the
// momentum m dv of its pin's motion, so its pin gives it m dv minus the impulses of all that acts on it: springs, gravity, drag,
// the stretch limit, constraints and contact.

/// Whether the record has what the settings ask for.
[[nodiscard]] bool records_as(const SimulatorSettings& settings, const RecordedImpulses& record);

/// Adds the recorded impulses on particles to the pins that hold them in an activity, and sets these to zero.
void collect_reactions(const std::vector<Pin>& pins, const Activity& activity, SimulationState& state);

/// The mean forces over `duration` [s] of all pins of the network and then of its attachments, each in the order in which they were
/// added. Zero if the duration is zero.
[[nodiscard]] std::vector<Reaction> mean_reactions(const SpringNetwork& network, const SimulationState& state, double duration);

}  // namespace sprung
