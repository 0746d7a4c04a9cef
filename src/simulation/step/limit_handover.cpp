#include "simulation/step/limit_handover.h"

namespace sprung {

void hand_over_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state) {
  const double most = wanted_excess(limit.settings());
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    StretchHandover& hold = state.stretch_holds[b];
    if (hold.solved_since || !limit.may_be_handed_over(b)) continue;
    const bool missed = excess > most && limit.excess(state.x, network.bodies[b]) > most;
    hold.missed_steps = missed ? hold.missed_steps + 1 : 0;
    if (hold.missed_steps >= kMostMissedSteps) hold.solved_since = state.step;
  }
}

}  // namespace sprung
