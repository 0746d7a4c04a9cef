// Verlet's step on coordinates one after another: x, y and z of consecutive particles.
#pragma once

#include "base/types.h"

namespace sprung {

struct VerletStep {
  double kept;    ///< part of the movement of the step before that goes on
  double per_dt;  ///< 1 / dt [1/s]
};

/// x += kept (x - x_previous) + gains forces, with gains dt^2 / m [s^2/kg]; x_previous becomes what x was, v what it moved per
/// time.
void advance_verlet(Index count, const VerletStep& step, const double* gains, const double* forces, double* x, double* x_previous,
                    double* v);

/// The same with gains forces = gained [m].
void advance_verlet(Index count, const VerletStep& step, const double* gained, double* x, double* x_previous, double* v);

/// v = (x - before) per_dt
void velocities_between(Index count, double per_dt, const double* before, const double* x, double* v);

}  // namespace sprung
