#include "dynamics/verlet_kernel.h"

#include "base/kernel.h"

namespace sprung {

SPRUNG_KERNEL
void advance_verlet(Index count, const VerletStep& step, const double* __restrict gains, const double* __restrict forces,
                    double* __restrict x, double* __restrict x_previous, double* __restrict v) {
  const double kept = step.kept;
  const double per_dt = step.per_dt;
  for (Index i = 0; i < count; ++i) {
    const double begin = x[i];
    const double end = begin + (kept * (begin - x_previous[i]) + gains[i] * forces[i]);
    x_previous[i] = begin;
    x[i] = end;
    v[i] = (end - begin) * per_dt;
  }
}

SPRUNG_KERNEL
void velocities_between(Index count, double per_dt, const double* __restrict before, const double* __restrict x,
                        double* __restrict v) {
  for (Index i = 0; i < count; ++i) v[i] = (x[i] - before[i]) * per_dt;
}

}  // namespace sprung
