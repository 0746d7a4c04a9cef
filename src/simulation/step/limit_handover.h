// Hands bodies whose stretch limit their solver keeps missing over to the other one, if that holds it better on the same step.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/simulation_state.h"

#include <cstddef>
#include <optional>

namespace sprung {

/// Counts for each eligible body the steps in a row that ended with more than wanted_excess(). `excess` is the largest excess of
/// all bodies after the present step [fraction of the rest length].
void note_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state);

/// The first body, by number, for which the other solver is to be tried in the next step.
[[nodiscard]] std::optional<std::size_t> body_to_compare(const SimulationState& state);

/// Changes the solver of a body.
void change_solver(std::size_t body, SimulationState& state);

/// Whether the other solver is worth the change, by the excess that each left after the same step. Newton's method costs more, so
/// it must leave at most four fifths of the excess of the passes.
[[nodiscard]] bool is_worth_changing(bool to_newton, double excess, double excess_of_other);

/// Starts to count again. A body that kept its solver waits twice as long as before.
void note_comparison(std::size_t body, bool changed, SimulationState& state);

}  // namespace sprung
