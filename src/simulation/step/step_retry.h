// Decides when a step with infeasible particles is repeated with more substeps.
#pragma once

#include "network/model/simulation_state.h"

#include <array>

namespace sprung {

/// A step is repeated with so many times its substeps, in this order, until no particle is infeasible.
inline constexpr std::array<int, 3> kRetryFactors{4, 16, 64};

/// Whether to repeat a step that began at the state `begun` and has this number of infeasible particles. After a repetition without
/// effect, no step is repeated for a waiting time, which doubles each time. A step with more infeasible particles than any during
/// the wait is repeated nevertheless, as its cause may be another.
[[nodiscard]] bool may_retry(Index infeasible, const SimulationState& begun);

/// Records the infeasible particles after each step. The wait ends after enough steps without any.
void note_step(Index infeasible, SimulationState& state);

/// Records the infeasible particles of a repeated step, at first and in the best repetition, and sets the wait.
void note_retry(Index infeasible_at_first, Index infeasible, SimulationState& state);

}  // namespace sprung
