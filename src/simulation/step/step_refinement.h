// Chooses the number of substeps from the stretch excess, or from the rotation, of the last step.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/simulation_state.h"

namespace sprung {

/// Halves the substeps as soon as a step ends with more excess than the bound, and doubles them after several steps in a row with
/// far less. The excess of a swinging body is proportional to the substep, that of a hanging body to its square, so twice the
/// substep is safe below a quarter of the bound.
class StepRefinement {
 public:
  /// Requires max_substeps >= 1.
  StepRefinement(const StretchLimitSettings& limit, int max_substeps);

  /// Chooses the substeps of the next step from the excess over the limit after the last one [fraction of the rest length].
  void choose(double excess, SimulationState& state) const;

  /// Chooses the substeps of the next step from the rotation in a substep of the last one (see StretchLimit::turn), such that a
  /// substep of the same motion rotates by at most 1/70, if `max_substeps` permits.
  void choose_by_turn(double turn, SimulationState& state) const;

 private:
  double bound_;  ///< on the excess
  int max_substeps_;
};

}  // namespace sprung
