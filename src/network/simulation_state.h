// All that a step changes. Time is counted in steps and their parts, never accumulated.
#pragma once

#include "network/spring_network.h"

#include <optional>
#include <vector>

namespace sprung {

/// How passes fare with the stretch limit of a body, and whether it was handed over to a global solve.
struct StretchHold {
  int missed_steps = 0;                      ///< in so many steps in a row, the last one included, they missed it
  std::optional<std::int64_t> solved_since;  ///< the step after which a global solve took over
};

struct SimulationState {
  std::int64_t step = 0;                   ///< steps that are done
  int halvings = 0;                        ///< the step at hand is made in 2^halvings equal parts
  int part = 0;                            ///< of which so many are done
  int calm_steps = 0;                      ///< so many in a row did not need their parts
  Points x;                                ///< positions [m], 3 x n
  Points v;                                ///< velocities [m/s], 3 x n
  Points x_previous;                       ///< Verlet's positions one step ago [m], 3 x n
  std::vector<StretchHold> stretch_holds;  ///< of bodies
};

/// How many parts as long as those at hand the state has behind it: time is this times their length, to the last bit what it is
/// in whole steps.
[[nodiscard]] inline std::int64_t parts_done(const SimulationState& state) {
  return state.step * (std::int64_t{1} << state.halvings) + state.part;
}

/// The state at time 0. Verlet's x_previous is set by the integrator, which knows the step.
[[nodiscard]] SimulationState initial_state(const SpringNetwork& network);

}  // namespace sprung
