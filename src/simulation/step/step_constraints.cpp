#include "simulation/step/step_constraints.h"

#include "simulation/step/step_check.h"

#include <algorithm>

namespace sprung {
namespace {

// Passes of contact when no stretch limit asks for more: enough for a particle in a corner between obstacles to settle.
constexpr int kContactPasses = 8;

// Passes end when none pushes a particle by more than this part of its gap.
constexpr double kContactTolerance = 1.0e-3;

// Corrections of stretch between the first pass and the last are so many times what is needed: of a hanging cloth's excess a third
// is left. But a spring on its own, which the first pass brings onto its limit, must not bounce there.
constexpr double kRelaxation = 1.8;

// Schemes that answer contact do so at most so often, and as often what truncation stopped.
constexpr int kAnswers = 6;

// Where surfaces stop particles short of where the passes led them, springs lead them and their neighbours on, at most so often,
// by so many passes each time, as many in all as the limit has: regions are made again before particles are far from where they
// were safe.
constexpr int kRelaxRounds = 16;
constexpr int kRelaxPasses = 2;

}  // namespace

StepConstraints::StepConstraints(const SpringNetwork& network, const SimulatorSettings& settings, double steady_acceleration,
                                 Environment& environment, Integrator& integrator)
    : settings_(settings), steady_acceleration_(steady_acceleration), integrator_(integrator), contacts_(network, environment) {
  if (!settings.stretch_limit) return;
  limit_.emplace(network, *settings.stretch_limit, limit_use(network, settings, !environment.obstacles().empty()));
}

void StepConstraints::begin(const SimulationState& state) {
  if (copies_positions()) before_ = state.x;
  if (contacts_.can_collide()) v_before_ = state.v;
}

void StepConstraints::hold(SimulationState& state, const Forces& forces, double dt, StepReport& report) {
  if (!contacts_.can_collide() && !limit_) return;
  if (contacts_.can_collide() || integrator_.needs_advanced()) advanced_ = state.x;
  dt_ = dt;
  constrain(state, forces, report);
  report.stretch_excess = limit_ ? limit_->excess(state.x) : 0.0;
  truncate(state, forces, report);
}

// Where contact and springs want particles elsewhere, what speaks last is held, and the other is off by what a pass moves. That is
// the gap, of which truncation leaves half: contact in the end would draw what hangs over a tip longer by as much, with few passes
// by a fifth of its length and more.
void StepConstraints::constrain(SimulationState& state, const Forces& forces, StepReport& report) {
  const bool projects = projects_contacts();
  if (projects) contacts_.find(motion());
  if (projects && integrator_.answers_contact()) answer_contact(state, forces);
  const double fall = steady_acceleration_ * dt_ * dt_;
  const std::optional<int> solves = limit_ ? limit_->solve(step_began(state), state.x, fall, state.stretch_holds) : std::nullopt;
  report.limit_solves = solves.value_or(0);
  const int limit_passes = limit_ ? limit_->settings().iterations + (solves ? 1 : 0) : 0;  // after a solve the first only measures
  if (projects) report.iterations = push_out(state.x, kContactPasses - limit_passes).passes;
  bool settled = false;
  for (int pass = 0; pass < limit_passes && !settled; ++pass) {
    const bool between = pass > 0 && pass + 1 < limit_passes;
    const double push = projects ? contacts_.project(state.x) : 0.0;
    const double excess =
        solves && pass == 0 ? limit_->excess(state.x) : limit_->project(step_began(state), state.x, between ? kRelaxation : 1.0);
    settled = excess <= limit_->settings().tolerance && push <= kContactTolerance;
    ++report.iterations;
  }
}

// Where springs take the others, contact pushes again.
void StepConstraints::answer_contact(SimulationState& state, const Forces& forces) {
  answered_ = advanced_;
  held_.clear(static_cast<Index>(state.x.cols()));
  for (int round = 0; round < kAnswers && push_out(state.x, kContactPasses).any; ++round) {
    held_.clear(static_cast<Index>(state.x.cols()));
    contacts_.hold_pushed(held_);
    integrator_.answer_contact(motion(), forces, answered_, held_, state);
    answered_ = state.x;
  }
}

StepConstraints::PushOut StepConstraints::push_out(Points& positions, int most_passes) {
  PushOut done;
  while (done.passes < most_passes) {
    const double push = contacts_.project(positions);
    ++done.passes;
    done.any = done.any || push > 0.0;
    if (push <= kContactTolerance) break;
  }
  return done;
}

void StepConstraints::truncate(SimulationState& state, const Forces& forces, StepReport& report) {
  const bool meets = contacts_.can_collide();
  const bool answers = !limit_ && integrator_.answers_contact() && projects_contacts();
  const int relax_rounds = limit_ ? std::min(kRelaxRounds, limit_->settings().iterations / kRelaxPasses) : 0;
  const int most_rounds = answers ? kAnswers : relax_rounds;
  int rounds = 0;
  const StepTruncation::Relax lead_on = [&](Points& positions) {
    if (rounds++ >= most_rounds) return false;
    return answers ? answer_truncation(state, forces) : relax(positions, report.stretch_excess);
  };
  if (answers) answered_ = state.x;
  if (meets) contacts_.truncate(motion(), state.x, lead_on);
  integrator_.recover_velocities(state, forces, step_began(state), advanced_, dt_);
  if (meets) contacts_.slow_down_taken_along(motion(), state, integrator_);
  if (meets) contacts_.settle_velocities(motion(), state, integrator_);
  report.truncated = contacts_.truncated_count();
  report.infeasible = contacts_.infeasible_count();
  if (limit_ && (rounds > 0 || report.truncated > 0)) report.stretch_excess = limit_->excess(state.x);
}

// What truncation stopped met something that no contact told of: those are found where it is now. What springs were too long before
// is none of truncation's doing, unless it is more than they may be longer altogether: then passes are wanted in any case.
bool StepConstraints::relax(Points& positions, double excess_before) {
  const StretchLimitSettings& limits = limit_->settings();
  if (limit_->excess(positions) <= std::max(limits.tolerance, std::min(excess_before, limits.max_stretch))) return false;
  if (projects_contacts()) contacts_.find_again(motion(), positions);
  for (int pass = 0; pass < kRelaxPasses; ++pass) {
    if (projects_contacts()) contacts_.project(positions);
    limit_->project(before_, positions);
  }
  return true;
}

// What truncation stopped is pushed too. It leads the state itself on.
bool StepConstraints::answer_truncation(SimulationState& state, const Forces& forces) {
  if (state.x == answered_) return false;
  for (Index i = 0; i < static_cast<Index>(state.x.cols()); ++i) {
    const Vector3 stopped = state.x.col(i) - answered_.col(i);
    if (!stopped.isZero(0.0)) held_.add(i, stopped);
  }
  integrator_.answer_contact(motion(), forces, answered_, held_, state);
  answered_ = state.x;
  return true;
}

bool StepConstraints::projects_contacts() const {
  return settings_.contact.response == ContactSettings::Response::projection && contacts_.can_collide();
}

}  // namespace sprung
