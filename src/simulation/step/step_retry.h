// When a step that infeasible particles is made again, in smaller ones.
#pragma once

#include "network/simulation_state.h"

#include <array>

namespace sprung {

/// It is made again in so many times as many parts, until it squeezes nothing.
inline constexpr std::array<int, 3> kRetryFactors{4, 16, 64};

/// Whether a step that began at the state and infeasible so many particles is. Where that did not help at all it is not tried for
/// some steps, each time for twice as many, unless more are infeasible than were left since it did: it may be something else.
[[nodiscard]] bool may_retry(Index infeasible, const SimulationState& begun);

/// Takes down in the state after each step how many particles it infeasible: what did may be over.
void note_step(Index infeasible, SimulationState& state);

/// Takes down in the state after a step that was made again how many particles it infeasible at first, and how many in the end.
void note_retry(Index infeasible_at_first, Index infeasible, SimulationState& state);

}  // namespace sprung
