#include "base/error.h"
#include "simulation/simulator_implementation.h"
#include "simulation/step/step_retry.h"

#include <utility>

namespace sprung {

// What a step leads far, by a lever or between obstacles that close, may find no place though there is one: in smaller steps
// contact answers before they meet. Of all attempts that of the fewest infeasible counts. What is wrung past its room finds none in
// any number of parts: an attempt that will not halve what is infeasible is left off, as it may take hundreds of times as long.
StepReport Simulator::Implementation::make_again(const StepReport& first, int more_at_first) {
  Made best = made(first);
  constraints.look_ahead(true);
  for (const int more : kRetryFactors) {
    if (best.report.max_infeasible == 0 || begun.state.substeps > kMaxSubsteps / more) break;
    if (more <= more_at_first) continue;
    const auto report = attempt(more, (best.report.max_infeasible + 1) / 2);
    if (report) best = made(*report);
  }
  constraints.look_ahead(false);
  constraints.roll_back(best.through);
  state = std::move(best.state);
  environment.set_interval(time(), time());
  energy_watch = best.watch;
  kept_contacts = best.contacts;
  note_retry(first.max_infeasible, best.report.max_infeasible, state);
  return best.report;
}

Made Simulator::Implementation::made(const StepReport& report) const {
  return {state, energy_watch, constraints.permitted_crossings(), report, contacts()};
}

/// None when it diverges, or squeezes too many particles.
std::optional<StepReport> Simulator::Implementation::attempt(int more, Index too_many) {
  state = begun.state;
  energy_watch = begun.watch;
  constraints.roll_back(begun.through);
  environment.set_interval(time(), time());
  try {
    const StepReport report = make_step(more, too_many);
    return report.max_infeasible < too_many ? std::optional(report) : std::nullopt;
  } catch (const StepError&) {
    integrator->set_fraction(1.0);
    set_substeps(begun.state.substeps);
    return std::nullopt;
  }
}

}  // namespace sprung
