#include "simulation/limit_handover.h"

namespace sprung {

namespace {

// A global solve takes several times as long as passes: it is to miss the limit by less than this part of what they do.
constexpr double kWorthwhile = 0.5;

}  // namespace

void hand_over_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state) {
  const double most = wanted_excess(limit.settings());
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    StretchHold& hold = state.stretch_holds[b];
    if (hold.given_back || !limit.may_be_handed_over(b)) continue;
    const double of_body = excess > most ? limit.excess(state.x, network.bodies[b]) : 0.0;
    const bool missed = of_body > most;
    hold.missed_steps = missed ? hold.missed_steps + 1 : 0;
    hold.missed_by = missed ? hold.missed_by + of_body : 0.0;
    if (hold.missed_steps < kMostMissedSteps) continue;
    if (!hold.solved_since) {
      hold.solved_since = state.step;
      hold.passes_missed_by = hold.missed_by;
    } else if (hold.missed_by >= kWorthwhile * hold.passes_missed_by) {
      hold.solved_since.reset();
      hold.given_back = true;
    }
    hold.missed_steps = 0;
    hold.missed_by = 0.0;
  }
}

}  // namespace sprung
