// Halves the obstacles' interval where it is too long for trapped particles.
#pragma once

#include "collision/truncation/vertex_truncation.h"

#include <functional>

namespace sprung {

/// The result of clipping all particles in a substep.
struct ClippedSubstep {
  Outcomes outcomes;
  bool path_checked =
      true;  ///< no element crosses anything along the path; false if a pin left its regions: then known for the end only
};

/// Clips particles to positions in `after` [m], 3 x n, in the substep of the paths. Returns the outcomes of the same particles each
/// time.
using ClipSubstep = std::function<ClippedSubstep(const StepPaths& paths, Points& after)>;

/// Clips particles in substeps of the paths' interval. Surfaces that close in on each other may leave no admissible
/// position along a straight path although there is one beside it. Shorter substeps find it, because planes are renewed before the
/// surfaces touch. Substeps are halved, down to 1/64 of the interval, while `clip` reports infeasible particles or an unchecked
/// path. Returns the outcomes of the last substep, but infeasible for particles that were infeasible in any.
Outcomes clip_in_substeps(const StepPaths& paths, Points& after, const ClipSubstep& clip);

}  // namespace sprung
