#include "simulation/step/limit_handover.h"

#include <algorithm>

namespace sprung {
namespace {

// Newton's method takes several steps from a large excess to the limit. Measured in its first step: 0.58 of what passes leave, both
// for a cloth that then keeps its limit and for one that soon misses it again.
constexpr double kWorthwhile = 0.8;

constexpr int kMostPatience = 1 << 20;  // steps

}  // namespace

void note_missed(const SpringNetwork& network, const StretchLimit& limit, double excess, SimulationState& state) {
  const double wanted = wanted_excess(limit.settings());
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    StretchHandover& handover = state.stretch_handovers[b];
    if (!limit.may_be_handed_over(b)) continue;
    const bool missed = excess > wanted && limit.excess(state.x, network.bodies[b]) > wanted;
    handover.missed_steps = missed ? handover.missed_steps + 1 : 0;
  }
}

std::optional<std::size_t> body_to_compare(const SimulationState& state) {
  const auto due = std::ranges::find_if(state.stretch_handovers,
                                        [](const StretchHandover& handover) { return handover.missed_steps >= handover.patience; });
  if (due == state.stretch_handovers.end()) return std::nullopt;
  return static_cast<std::size_t>(due - state.stretch_handovers.begin());
}

void change_solver(std::size_t body, SimulationState& state) {
  auto& since = state.stretch_handovers[body].solved_since;
  since = since ? std::nullopt : std::optional(state.step);
}

bool is_worth_changing(bool to_newton, double excess, double excess_of_other) {
  return excess_of_other <= (to_newton ? kWorthwhile : 1.0) * excess;
}

void note_comparison(std::size_t body, bool changed, SimulationState& state) {
  StretchHandover& handover = state.stretch_handovers[body];
  handover.missed_steps = 0;
  handover.patience = changed ? kFirstPatience : std::min(2 * handover.patience, kMostPatience);
}

}  // namespace sprung
