#include "simulation/step/step_planner.h"

#include "network/model/spring_network.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung {
namespace {

// Largest rotation of an obstacle or a pin in a substep [degrees]. In the frame of a rotating obstacle, particles are assumed to
// move straight in a substep: after a rotation by 180 degrees, through its centre.
constexpr double kMaxRotation = 45.0;

// A step in which surfaces stop the ends of a spring so differently that it is strained by more than this is repeated with more
// contact steps, up to one for each inner substep. The strain would become speed: a cloth of stiff springs that struck a spike at
// 8 m/s got three times the energy that it had.
constexpr double kMostStrain = 0.1;
constexpr std::array<int, 2> kStrainFactors{4, 16};

// Factors on the substeps of repeated steps, in this order. Rotation asks for no more than the last one.
constexpr std::array<int, 3> kRetryFactors{4, 16, 64};

// Twice the step gives two to four times the excess: the step is doubled below this fraction of the bound.
constexpr double kRoom = 0.25;
constexpr int kCalmSteps = 8;

constexpr double kMaxDeformation = 1.0 / 70.0;

// The longest wait without repetitions [steps]. It ends after kLeastFree steps without infeasible particles plus 1 / kForgetting of
// the wait: a cause that returns every few steps is treated as one that persists.
constexpr int kMaxWait = 1024;
constexpr int kLeastFree = 4;
constexpr int kForgetting = 16;

// Newton's method takes several steps from a large excess to the limit. Measured in its first step: 0.58 of what passes leave, both
// for a cloth that then keeps its limit and for one that soon misses it again.
constexpr double kWorthwhile = 0.8;
constexpr int kMostPatience = 1 << 20;  // steps

/// More contact steps have fewer inner substeps, which are no longer than before.
int divided(int inner, int factor) { return 1 + (inner - 1) / factor; }

bool may_repeat(Index infeasible, const SimulationState& begin) {
  const PlannerMemory& memory = begin.planner;
  return infeasible > 0 && (begin.step >= memory.retry_from || infeasible > memory.retry_infeasible);
}

bool is_worth_changing(const SolverTrial& trial, double excess, double excess_of_other) {
  return excess_of_other <= (trial.newton ? kWorthwhile : 1.0) * excess;
}

}  // namespace

StepPlanner::StepPlanner(const SpringNetwork& network, const SimulatorSettings& settings, const StretchLimit* limit,
                         bool forces_need_inner)
    : network_(network),
      limit_(limit),
      inner_substeps_(settings.inner_substeps),
      forces_need_inner_(forces_need_inner && settings.inner_substeps > 1),
      max_substeps_(limit != nullptr ? settings.max_substeps : 1),
      awaits_newton_(limit != nullptr && limit->may_follow_deformation()) {}

/// Global solves need no small steps.
int StepPlanner::inner(const SimulationState& state) const {
  const bool solves =
      limit_ != nullptr && inner_substeps_ > 1 && !forces_need_inner_ && limit_->follows_deformation(state.limit.handovers);
  return solves ? 1 : inner_substeps_;
}

/// Those of the next step.
int StepPlanner::contact_steps(const SimulationState& state) const { return std::max(1, state.substeps / inner(state)); }

void StepPlanner::start(bool moves, SimulationState& state) const {
  state.substeps = inner(state);
  const bool by_passes = awaits_newton_ && inner_substeps_ == 1;
  if (max_substeps_ == 1 || !(by_passes || (limit_->follows_deformation() && moves))) return;
  state.substeps *= max_substeps_;
  state.planner.reason = awaits_newton_ ? PlanReason::excess : PlanReason::deformation;
}

void StepPlanner::note_change(bool restrains, SimulationState& state) const {
  const int steps = restrains && inner_substeps_ == 1 ? max_substeps_ : std::min(contact_steps(state), max_substeps_);
  state.substeps = steps * inner(state);
  if (restrains && max_substeps_ > 1) state.planner.reason = PlanReason::excess;
}

StepPlan StepPlanner::first(const SimulationState& begin, double rotation) const {
  const int steps = contact_steps(begin);
  const int most = std::min(kRetryFactors.back(), kMaxSubsteps / begin.substeps);
  const double needed = std::ceil(rotation / (kMaxRotation * steps));
  const int factor = static_cast<int>(std::clamp(needed, 1.0, static_cast<double>(most)));
  const PlanReason reason = begin.substeps > inner(begin) ? begin.planner.reason : PlanReason::first;
  return {.contact_steps = factor * steps,
          .inner = divided(inner(begin), factor),
          .reason = factor > 1 ? PlanReason::rotation : reason};
}

std::optional<StepPlan> StepPlanner::next(std::span<const StepTrial> tried, const SimulationState& begin) const {
  if (tried.back().plan.trial) return std::nullopt;
  if (auto plan = repetition(tried, begin)) return plan;
  // Excess from different steps cannot be compared, so both solvers make the same step.
  const StepTrial& best = tried[this->best(tried)];
  const auto body = body_to_compare(begin);
  if (!body || !best.plan.global_limit) return std::nullopt;
  StepPlan plan = best.plan;
  plan.trial = {.body = *body, .newton = !begin.limit.handovers[*body].solved_since};
  plan.abandon_at = best.report.max_infeasible + 1;
  plan.reason = PlanReason::solver_trial;
  return plan;
}

std::optional<StepPlan> StepPlanner::repetition(std::span<const StepTrial> tried, const SimulationState& begin) const {
  const Index infeasible = tried[best(tried)].report.max_infeasible;
  if (infeasible == 0) return repetition_for_strain(tried, begin);
  if (!may_repeat(tried.front().report.max_infeasible, begin)) return std::nullopt;
  const int steps = contact_steps(begin);
  for (const int factor : kRetryFactors) {
    if (begin.substeps > kMaxSubsteps / factor) break;
    if (factor * steps <= tried.back().plan.contact_steps) continue;
    return StepPlan{.contact_steps = factor * steps,
                    .inner = divided(inner(begin), factor),
                    .global_limit = false,  // a global solve does not know contacts and moves particles far
                    .abandon_at = (infeasible + 1) / 2,
                    .reason = PlanReason::infeasible};
  }
  return std::nullopt;
}

std::optional<StepPlan> StepPlanner::repetition_for_strain(std::span<const StepTrial> tried, const SimulationState& begin) const {
  if (inner(begin) == 1 || tried.back().report.truncation_strain <= kMostStrain) return std::nullopt;
  const int steps = contact_steps(begin);
  const int most = std::min(std::max(kStrainFactors.front(), inner(begin)), kMaxSubsteps / begin.substeps);
  for (const int factor : kStrainFactors) {
    if (factor > most) break;
    if (factor * steps <= tried.back().plan.contact_steps) continue;
    return StepPlan{.contact_steps = factor * steps, .inner = divided(inner(begin), factor), .reason = PlanReason::strain};
  }
  return std::nullopt;
}

std::size_t StepPlanner::best(std::span<const StepTrial> tried) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < tried.size(); ++k) {
    const StepTrial& trial = tried[k];
    if (!trial.is_complete) continue;
    if (trial.plan.trial && !is_worth_changing(*trial.plan.trial, tried[best].body_excess, trial.body_excess)) continue;
    best = k;
  }
  return best;
}

void StepPlanner::learn(std::span<const StepTrial> tried, SimulationState& state) const {
  const StepReport& report = tried[best(tried)].report;
  learn_of_repetitions(tried, state);
  learn_of_trial(tried, state);
  choose_substeps(tried, state);
  if (limit_ != nullptr) count_missed(report.stretch_excess, state);
}

void StepPlanner::learn_of_repetitions(std::span<const StepTrial> tried, SimulationState& state) const {
  PlannerMemory& memory = state.planner;
  const StepReport& kept = tried[best(tried)].report;
  if (std::ranges::any_of(tried, [](const StepTrial& trial) { return trial.plan.reason == PlanReason::infeasible; })) {
    if (kept.max_infeasible == 0) {
      memory.retry_wait = 0;
    } else if (kept.max_infeasible == tried.front().report.max_infeasible) {
      memory.retry_wait = std::clamp(2 * memory.retry_wait, 1, kMaxWait);
    }
    memory.retry_from = state.step + memory.retry_wait;
    memory.retry_infeasible = kept.max_infeasible > 0 ? std::max(memory.retry_infeasible, kept.max_infeasible) : 0;
  }
  memory.feasible_steps = kept.infeasible > 0 ? 0 : std::min(memory.feasible_steps + 1, kMaxWait);
  if (memory.feasible_steps <= kLeastFree + memory.retry_wait / kForgetting) return;
  memory.retry_wait = 0;
  memory.retry_from = state.step;
  memory.retry_infeasible = 0;
}

void StepPlanner::learn_of_trial(std::span<const StepTrial> tried, SimulationState& state) const {
  if (!tried.back().plan.trial) return;
  StretchHandover& handover = state.limit.handovers[tried.back().plan.trial->body];
  const bool changes = best(tried) + 1 == tried.size();
  handover.missed_steps = 0;
  handover.patience = changes ? kFirstPatience : std::min(2 * handover.patience, kMostPatience);
}

void StepPlanner::choose_substeps(std::span<const StepTrial> tried, SimulationState& state) const {
  if (max_substeps_ == 1 && inner_substeps_ == 1) return;
  if (max_substeps_ == 1) {
    state.substeps = inner(state);
  } else if (limit_->follows_deformation(state.limit.handovers)) {
    // Passes alone measure no deformation: then the first attempt tells it.
    const StepTrial& kept = tried[best(tried)];
    const StepTrial& measured = kept.plan.global_limit ? kept : tried.front();
    choose_by_deformation(measured.report.deformation * measured.plan.substeps(), state);
  } else if (awaits_newton_ && inner_substeps_ == 1) {
    state.substeps = max_substeps_;  // which the solve did not need before the body came back
    state.planner.reason = PlanReason::excess;
  } else {
    choose_by_excess(tried[best(tried)].report.stretch_excess, state);
  }
}

void StepPlanner::choose_by_excess(double excess, SimulationState& state) const {
  const double bound = tolerated_excess(limit_->settings(), true);
  const int steps = contact_steps(state);
  PlannerMemory& memory = state.planner;
  if (excess > bound) {
    const int halvings = 1 + std::ilogb(excess / bound);
    const double wanted = std::min(std::ldexp(steps, halvings), static_cast<double>(max_substeps_));
    state.substeps = static_cast<int>(wanted) * inner_substeps_;
    memory.reason = PlanReason::excess;
    memory.calm_steps = 0;
    return;
  }
  memory.calm_steps = excess < kRoom * bound ? memory.calm_steps + 1 : 0;
  if (memory.calm_steps < kCalmSteps || steps == 1) return;
  state.substeps = steps / 2 * inner_substeps_;
  memory.calm_steps = 0;
}

/// `deformation` is that of the whole step, if each substep deforms bodies alike.
void StepPlanner::choose_by_deformation(double deformation, SimulationState& state) const {
  const double needed = std::ceil(deformation / kMaxDeformation);
  state.substeps =
      needed > 1.0 ? static_cast<int>(std::min(needed, static_cast<double>(max_substeps_))) : 1;  // also if not a number
  state.planner.reason = PlanReason::deformation;
}

/// Counts for each eligible body the steps in a row that ended with more excess than wanted.
void StepPlanner::count_missed(double excess, SimulationState& state) const {
  const double wanted = tolerated_excess(limit_->settings(), inner_substeps_ > 1);
  for (std::size_t b = 0; b < network_.bodies.size(); ++b) {
    if (!limit_->may_be_handed_over(b)) continue;
    StretchHandover& handover = state.limit.handovers[b];
    const bool missed = excess > wanted && limit_->excess(state.x, network_.bodies[b]) > wanted;
    handover.missed_steps = missed ? handover.missed_steps + 1 : 0;
  }
}

std::optional<std::size_t> StepPlanner::body_to_compare(const SimulationState& begin) const {
  const auto due = std::ranges::find_if(begin.limit.handovers,
                                        [](const StretchHandover& handover) { return handover.missed_steps >= handover.patience; });
  if (due == begin.limit.handovers.end()) return std::nullopt;
  return static_cast<std::size_t>(due - begin.limit.handovers.begin());
}

}  // namespace sprung
