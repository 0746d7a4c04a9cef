// What a step did, and what ended one early.
#pragma once

#include "base/types.h"

#include <stdexcept>

namespace sprung {

/// What one step did: sums over its parts, and the largest excess.
struct StepReport {
  int substeps = 0;             ///< that it was made in
  int iterations = 0;           ///< passes of stretch limit and contact
  int limit_solves = 0;         ///< linear systems that the stretch limit solved in turn
  double stretch_excess = 0.0;  ///< beyond the stretch limit at the end of a part, as a part of the rest length
  Index truncated = 0;          ///< particles stopped at a surface
  Index infeasible = 0;         ///< particles that found no free place between obstacles, pins and each other
  Index max_infeasible = 0;     ///< of those, the most in one part
  double turn = 0.0;            ///< of what a global solve holds, in a part at the pace of the last one, see StretchLimit::turn

  StepReport& operator+=(const StepReport& substep);
};

/// A step was left off, as somebody asked for; the state it left behind must not be used.
class StoppedError : public std::runtime_error {
 public:
  StoppedError() : std::runtime_error("the step was stopped") {}
};

}  // namespace sprung
