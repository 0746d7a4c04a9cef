// A step on its way, before constraints and contact answer.
#pragma once

#include "base/types.h"

namespace sprung {

/// A step of `dt` [s] that began with positions `before` [m] and velocities `v_before` [m/s], and whose forces alone would end in
/// `advanced` [m].
struct StepMotion {
  const Points& before;
  const Points& v_before;
  const Points& advanced;
  double dt = 0.0;
};

}  // namespace sprung
