// States that go on in another model.
#pragma once

#include "dynamics/state/simulation_state.h"
#include "simulation/model.h"

namespace sprung {

/// The state in a model of the same particles: springs that broke stay broken, and pins that a program added or moves go on.
[[nodiscard]] SimulationState continued_in(const Model& next, const Model& before, const SimulationState& state);

}  // namespace sprung
