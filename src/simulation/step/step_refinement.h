// In how many parts a step is made, by the stretch that the one before left, or by how far things turned in it.
#pragma once

#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/simulation_state.h"

namespace sprung {

/// Parts are halved as soon as a step leaves springs longer than the limit lets them be, and doubled again once several in a row
/// left far less. The excess of what swings falls with the step, that of what hangs with its square: a doubled part is safe where a
/// quarter of the bound is not reached.
class StepRefinement {
 public:
  /// A step is made in `max_substeps` at most, >= 1.
  StepRefinement(const StretchLimitSettings& limit, int max_substeps);

  /// Chooses the parts of the step to come when one has left `excess` over the limit, as a part of the rest length.
  void choose(double excess, SimulationState& state) const;

  /// Chooses them when a part of the step has turned something by `turn`, as StretchLimit::turn says: so many that a part turns it
  /// by no more than a seventieth, where `max_substeps` lets it. Of a motion that changes little from step to step none is made too
  /// large.
  void choose_by_turn(double turn, SimulationState& state) const;

 private:
  double bound_;  ///< of the excess
  int max_substeps_;
};

}  // namespace sprung
