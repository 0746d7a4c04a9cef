#include "dynamics/integrators/verlet_kernel.h"

#include "base/machine/kernel.h"

namespace sprung {

namespace {

[[gnu::always_inline]] inline void advance_one(const VerletStep& step, double gained, double& x, double& x_previous, double& v) {
  const double begin = x;
  const double end = begin + (step.kept * (begin - x_previous) + gained);
  x_previous = begin;
  x = end;
  v = (end - begin) * step.per_dt;
}

}  // namespace

SPRUNG_KERNEL
void advance_verlet(Index count, const VerletStep& step, const double* __restrict gains, const double* __restrict forces,
                    double* __restrict x, double* __restrict x_previous, double* __restrict v) {
  const VerletStep of_all = step;
  for (Index i = 0; i < count; ++i) advance_one(of_all, gains[i] * forces[i], x[i], x_previous[i], v[i]);
}

SPRUNG_KERNEL
void advance_verlet(Index count, const VerletStep& step, const double* __restrict gained, double* __restrict x,
                    double* __restrict x_previous, double* __restrict v) {
  const VerletStep of_all = step;
  for (Index i = 0; i < count; ++i) advance_one(of_all, gained[i], x[i], x_previous[i], v[i]);
}

SPRUNG_KERNEL
void velocities_between(Index count, double per_dt, const double* __restrict before, const double* __restrict x,
                        double* __restrict v) {
  for (Index i = 0; i < count; ++i) v[i] = (x[i] - before[i]) * per_dt;
}

}  // namespace sprung
