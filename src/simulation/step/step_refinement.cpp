#include "simulation/step/step_refinement.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// A hanging body bounces at first, to 1.5 times the wanted excess. A smaller step would remove the excess faster and increase the
// bounce, so only a larger excess, which needs motion, halves the step.
constexpr double kMargin = 3.0;

// Twice the step gives two to four times the excess: the step is doubled below this fraction of the bound.
constexpr double kRoom = 0.25;

constexpr int kCalmSteps = 8;

// The projection at the end of a step damps motion in proportion to the step.
constexpr double kMaxTurn = 1.0 / 70.0;

}  // namespace

StepRefinement::StepRefinement(const StretchLimitSettings& limit, int max_substeps)
    : bound_(kMargin * wanted_excess(limit)), max_substeps_(max_substeps) {}

void StepRefinement::choose(double excess, SimulationState& state) const {
  if (excess > bound_) {
    const int halvings = 1 + std::ilogb(excess / bound_);
    state.substeps = static_cast<int>(std::min(std::ldexp(state.substeps, halvings), static_cast<double>(max_substeps_)));
    state.calm_steps = 0;
    return;
  }
  state.calm_steps = excess < kRoom * bound_ ? state.calm_steps + 1 : 0;
  if (state.calm_steps < kCalmSteps || state.substeps == 1) return;
  state.substeps /= 2;
  state.calm_steps = 0;
}

void StepRefinement::choose_by_turn(double turn, SimulationState& state) const {
  const double needed = std::ceil(turn * state.substeps / kMaxTurn);
  state.substeps =
      needed > 1.0 ? static_cast<int>(std::min(needed, static_cast<double>(max_substeps_))) : 1;  // also if `turn` is not a number
}

}  // namespace sprung
