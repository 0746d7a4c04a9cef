// How a step is made, and what came of it.
#pragma once

#include "dynamics/state/simulation_state.h"
#include "simulation/step/step_report.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace sprung {

/// A trial of the solver that does not enforce the stretch limit of a body at present.
struct SolverTrial {
  std::size_t body = 0;
  bool newton = false;  ///< whether the trial is of Newton's method, or of passes
};

struct StepPlan {
  int contact_steps = 1;     ///< parts of the step for which contacts are found anew
  int inner = 1;             ///< substeps of each, in which forces and the stretch limit act; 1 until inner substeps exist
  bool global_limit = true;  ///< whether global solves enforce the stretch limit where they do otherwise; or passes alone
  std::optional<SolverTrial> trial{};
  Index abandon_at = std::numeric_limits<Index>::max();  ///< infeasible particles in a substep that end the attempt
  PlanReason reason = PlanReason::first;

  [[nodiscard]] int substeps() const { return contact_steps * inner; }
};

/// An attempt at a step.
struct StepTrial {
  StepPlan plan;
  StepReport report;
  bool is_complete = true;   ///< it was neither abandoned nor did it diverge
  double body_excess = 0.0;  ///< excess over the stretch limit of the body whose solvers are compared, at the end
};

}  // namespace sprung
