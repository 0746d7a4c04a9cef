#include "simulation/step/step_retry.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr int kMostWait = 1024;  // steps

// What squeezed is over after so many steps that squeezed nothing, and such a part of the wait more: what squeezes every few steps
// is tried as rarely as what always does.
constexpr int kLeastFree = 4;
constexpr int kForgetting = 16;

}  // namespace

bool may_retry(Index squeezed, const SimulationState& begun) {
  return squeezed > 0 && (begun.step >= begun.retry_from || squeezed > begun.retry_squeezed);
}

void note_retry(Index squeezed_at_first, Index squeezed, SimulationState& state) {
  if (squeezed == 0) {
    state.retry_wait = 0;
  } else if (squeezed == squeezed_at_first) {
    state.retry_wait = std::clamp(2 * state.retry_wait, 1, kMostWait);
  }
  state.retry_from = state.step + state.retry_wait;
  state.retry_squeezed = squeezed > 0 ? std::max(state.retry_squeezed, squeezed) : 0;
}

void note_step(Index squeezed, SimulationState& state) {
  state.free_steps = squeezed > 0 ? 0 : std::min(state.free_steps + 1, kMostWait);
  if (state.free_steps <= kLeastFree + state.retry_wait / kForgetting) return;
  state.retry_wait = 0;
  state.retry_from = state.step;
  state.retry_squeezed = 0;
}

}  // namespace sprung
