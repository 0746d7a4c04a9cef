// When a step that squeezed particles is made again, in smaller ones.
#pragma once

#include "network/simulation_state.h"

#include <array>

namespace sprung {

/// It is made again in so many times as many parts, until it squeezes nothing.
inline constexpr std::array<int, 3> kRetryParts{4, 16, 64};

/// Whether a step that began at the state and squeezed so many particles is. Where that did not help at all it is not tried for
/// some steps, each time for twice as many, unless more are squeezed than were left since it did: it may be something else.
[[nodiscard]] bool may_retry(Index squeezed, const SimulationState& begun);

/// Takes down in the state after each step how many particles it squeezed: what did may be over.
void note_step(Index squeezed, SimulationState& state);

/// Takes down in the state after a step that was made again how many particles it squeezed at first, and how many in the end.
void note_retry(Index squeezed_at_first, Index squeezed, SimulationState& state);

}  // namespace sprung
