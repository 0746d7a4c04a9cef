// The report of a step, and the exception that ends one early.
#pragma once

#include "base/types.h"
#include "dynamics/state/simulation_state.h"

#include <stdexcept>

namespace sprung {

/// Counts of one step, summed over its substeps, and the largest excess.
struct StepReport {
  int substeps = 0;                       ///< number of substeps
  int iterations = 0;                     ///< passes over stretch limit and contact
  int limit_solves = 0;                   ///< linear systems solved for the stretch limit
  double stretch_excess = 0.0;            ///< largest at the end of a substep [fraction of the rest length]
  Index truncated = 0;                    ///< particles that truncation stopped
  double truncation_strain = 0.0;         ///< largest strain of a spring by truncation after several inner substeps [1]
  Index infeasible = 0;                   ///< particles without an admissible position
  Index max_infeasible = 0;               ///< the most in one substep
  double deformation = 0.0;               ///< of the last substep; see StretchLimit::deformation
  PlanReason reason = PlanReason::first;  ///< why the step has its substeps

  StepReport& operator+=(const StepReport& substep);
};

/// A step was stopped by Simulator::stop_when. The simulator is as it was before the step.
class StoppedError : public std::runtime_error {
 public:
  StoppedError() : std::runtime_error("the step was stopped") {}
};

}  // namespace sprung
