#include "simulation/step/step_retry.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr int kMaxWait = 1024;  // steps

// The wait ends after kLeastFree steps without infeasible particles plus 1 / kForgetting of the wait: a cause that returns every
// few steps is treated as one that persists.
constexpr int kLeastFree = 4;
constexpr int kForgetting = 16;

}  // namespace

bool may_retry(Index infeasible, const SimulationState& begun) {
  return infeasible > 0 && (begun.step >= begun.retry_from || infeasible > begun.retry_infeasible);
}

void note_retry(Index infeasible_at_first, Index infeasible, SimulationState& state) {
  if (infeasible == 0) {
    state.retry_wait = 0;
  } else if (infeasible == infeasible_at_first) {
    state.retry_wait = std::clamp(2 * state.retry_wait, 1, kMaxWait);
  }
  state.retry_from = state.step + state.retry_wait;
  state.retry_infeasible = infeasible > 0 ? std::max(state.retry_infeasible, infeasible) : 0;
}

void note_step(Index infeasible, SimulationState& state) {
  state.feasible_steps = infeasible > 0 ? 0 : std::min(state.feasible_steps + 1, kMaxWait);
  if (state.feasible_steps <= kLeastFree + state.retry_wait / kForgetting) return;
  state.retry_wait = 0;
  state.retry_from = state.step;
  state.retry_infeasible = 0;
}

}  // namespace sprung
