#include "simulation/step/limit_handover.h"

namespace sprung {

void hand_over_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state) {
  const double wanted = wanted_excess(limit.settings());
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    StretchHandover& handover = state.stretch_handovers[b];
    if (handover.solved_since || !limit.may_be_handed_over(b)) continue;
    const bool missed = excess > wanted && limit.excess(state.x, network.bodies[b]) > wanted;
    handover.missed_steps = missed ? handover.missed_steps + 1 : 0;
    if (handover.missed_steps >= kMaxMissedSteps) handover.solved_since = state.step;
  }
}

}  // namespace sprung
