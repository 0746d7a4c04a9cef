// Verlet's step on contiguous coordinates: x, y and z of consecutive particles.
#pragma once

#include "base/types.h"

namespace sprung {

struct VerletStep {
  double kept;    ///< fraction of the last step's movement that is kept: 1 - damping
  double per_dt;  ///< 1 / dt [1/s]
};

/// x += kept (x - x_previous) + gains * forces, where gains are dt^2 / m [s^2/kg]. x_previous becomes the old x, and v the
/// movement per time.
void advance_verlet(Index count, const VerletStep& step, const double* gains, const double* forces, double* x, double* x_previous,
                    double* v);

/// As above, with the product `gained` = gains * forces [m] given.
void advance_verlet(Index count, const VerletStep& step, const double* gained, double* x, double* x_previous, double* v);

/// v = (x - before) per_dt
void velocities_between(Index count, double per_dt, const double* before, const double* x, double* v);

}  // namespace sprung
