// The rules for a state with which a simulator continues.
#pragma once

#include "dynamics/state/simulation_state.h"
#include "simulation/control.h"
#include "simulation/model.h"

namespace sprung {

/// What the state must fit.
struct StateOwner {
  const Model& model;
  const Control& control;
  Index sleep_groups = 0;    ///< their number
  bool can_collide = false;  ///< whether there is anything that the network may touch
};

/// Throws InputError with every number of the state that is not finite, and every count or index that does not fit its owner.
void check_state(const StateOwner& owner, const SimulationState& state);

}  // namespace sprung
