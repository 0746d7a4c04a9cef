#include "base/error.h"
#include "simulation/simulator_implementation.h"
#include "simulation/step/limit_handover.h"
#include "simulation/step/step_retry.h"

namespace sprung {

// A particle that moves far in a step, on a lever or between closing obstacles, may miss an admissible position that exists. With
// smaller substeps, contact acts before the surfaces touch. The attempt with the fewest infeasible particles wins. If there is no
// admissible position, no number of substeps helps: an attempt that does not halve the infeasible particles is abandoned, as it
// could take hundreds of times longer.
StepReport Simulator::Implementation::repeat_step(const StepReport& first, int factor_at_first) {
  Attempt best = attempt_of(first);
  for (const int factor : kRetryFactors) {
    if (best.report.max_infeasible == 0 || begin.state.substeps > kMaxSubsteps / factor) break;
    if (factor <= factor_at_first) continue;
    const auto report = attempt(factor, (best.report.max_infeasible + 1) / 2, true);
    if (report) best = attempt_of(*report);
  }
  const StepReport report = best.report;
  return_to(best.state, best.crossings);
  note_retry(first.max_infeasible, report.max_infeasible, state);
  return report;
}

// What a solver missed in former steps says nothing of what the other would miss in them, so both make the same step.
StepReport Simulator::Implementation::compare_solvers(std::size_t body, const StepReport& first, int factor) {
  const auto excess = [&] { return constraints.limit()->excess(state.x, network.bodies[body]); };
  const double excess_of_first = excess();
  const Attempt present = attempt_of(first);
  const StretchHandover at_begin = begin.state.stretch_handovers[body];
  const bool to_newton = !at_begin.solved_since;
  change_solver(body, begin.state);
  const auto other = attempt(factor, first.max_infeasible + 1, false);
  begin.state.stretch_handovers[body] = at_begin;
  const bool changes = other && is_worth_changing(to_newton, excess_of_first, excess());
  const StepReport report = changes ? *other : present.report;
  if (!changes) return_to(present.state, present.crossings);
  note_comparison(body, changes, state);
  return report;
}

/// Continues from a former state of this step.
void Simulator::Implementation::return_to(const SimulationState& former, const PermittedCrossings& crossings) {
  state = former;
  constraints.roll_back(crossings);
  constraints.look_ahead(false);
  integrator->set_fraction(1.0);
  step_length_changed();
  environment.set_interval(time(), time());
  if (attachments) attachments->take(state, time());
}

Attempt Simulator::Implementation::attempt_of(const StepReport& report) const {
  return {state, constraints.permitted_crossings(), report};
}

/// Nothing if the step diverges, or has at least `max_infeasible` infeasible particles.
std::optional<StepReport> Simulator::Implementation::attempt(int factor, Index max_infeasible, bool ahead) {
  return_to(begin.state, begin.crossings);
  constraints.look_ahead(ahead);
  try {
    const StepReport report = make_step(factor, max_infeasible);
    return report.max_infeasible < max_infeasible ? std::optional(report) : std::nullopt;
  } catch (const StepError&) {
    return std::nullopt;
  }
}

}  // namespace sprung
