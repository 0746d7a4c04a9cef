// All that a step changes. Time is `step * dt`, never accumulated.
#pragma once

#include "network/spring_network.h"

namespace sprung {

struct SimulationState {
  std::int64_t step = 0;
  Points x;           ///< positions [m], 3 x n
  Points v;           ///< velocities [m/s], 3 x n
  Points x_previous;  ///< Verlet's positions one step ago [m], 3 x n
};

/// The state at time 0. Verlet's x_previous is set by the integrator, which knows the step.
[[nodiscard]] SimulationState initial_state(const SpringNetwork& network);

}  // namespace sprung
