// All that a step changes. Time is counted in steps and their parts, never accumulated.
#pragma once

#include "network/spring_network.h"

#include <optional>
#include <vector>

namespace sprung {

/// How passes fare with the stretch limit of a body, and whether it was handed over to a global solve.
struct StretchHandover {
  int missed_steps = 0;                      ///< in so many steps in a row, the last one included, they missed it
  std::optional<std::int64_t> solved_since;  ///< the step after which a global solve took over
};

struct SimulationState {
  std::int64_t step = 0;        ///< steps that are done
  int substeps = 1;             ///< the step at hand is made in so many equal parts
  int substep = 0;              ///< of which so many are done
  int calm_steps = 0;           ///< so many in a row did not need their parts
  int free_steps = 0;           ///< so many in a row infeasible nothing
  std::int64_t retry_from = 0;  ///< steps before this one are not made again where they squeeze anything
  int retry_wait = 0;           ///< so many steps after the last one for which that did not help
  Index retry_infeasible = 0;   ///< but for those that squeeze more than this, the most that was left since it helped
  Points x;                     ///< positions [m], 3 x n
  Points v;                     ///< velocities [m/s], 3 x n
  Points x_previous;            ///< Verlet's positions one step ago [m], 3 x n
  std::vector<StretchHandover> stretch_handovers;  ///< of bodies
};

/// How many steps the state has behind it, with the parts of the one at hand: time is this times their length, to the last bit what
/// it is in whole steps.
[[nodiscard]] inline double steps_done(const SimulationState& state) {
  return static_cast<double>(state.step) + static_cast<double>(state.substep) / state.substeps;
}

/// The state at time 0. Verlet's x_previous is set by the integrator, which knows the step.
[[nodiscard]] SimulationState initial_state(const SpringNetwork& network);

}  // namespace sprung
