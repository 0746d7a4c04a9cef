// The motion of a step before constraints and contact respond.
#pragma once

#include "base/types.h"

namespace sprung {

struct Slip;

/// A step of `dt` [s] that begins at positions `before` [m] with velocities `v_before` [m/s] and the state's slip `slip_before`;
/// forces alone would end it at `advanced` [m].
struct StepMotion {
  const Points& before;
  const Points& v_before;
  const Slip& slip_before;
  const Points& advanced;
  double dt = 0.0;
};

}  // namespace sprung
