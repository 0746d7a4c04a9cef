#include "simulation/step/step_refinement.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// Steps are chosen to come near the wanted excess of what hangs, which bounces to half as much again at first. A smaller step takes
// back what is too long faster, and so would make that bounce the higher: only what moves misses by more.
constexpr double kMargin = 3.0;

// Doubled, a step leaves two to four times as much: less than this part of the bound must be left for that.
constexpr double kRoom = 0.25;

constexpr int kCalmSteps = 8;

// A limit that is held at the end of a step takes of the motion in proportion to the step.
constexpr double kMostTurn = 1.0 / 70.0;

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
  const double needed = std::ceil(turn * state.substeps / kMostTurn);
  state.substeps =
      needed > 1.0 ? static_cast<int>(std::min(needed, static_cast<double>(max_substeps_))) : 1;  // 1 for what is no number
}

}  // namespace sprung
