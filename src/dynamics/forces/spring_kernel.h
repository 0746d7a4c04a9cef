// Spring-damper forces of short batches of springs: the inner loop of SpringForce.
#pragma once

#include "base/machine/simd.h"

namespace sprung {

/// Largest number of springs in a batch. The buffers of a batch stay in the first-level cache.
inline constexpr Index kSpringBatch = 64;

/// A constant of the springs of a batch: an entry per spring, or kSimdWidth equal entries for all.
struct SpringConstant {
  const double* values;
  bool same;

  [[nodiscard]] const double* at(Index i) const { return same ? values : values + i; }
};

struct SpringConstants {
  SpringConstant rest_length;
  SpringConstant stiffness;
  SpringConstant damping;
  bool tension_only = false;  ///< springs that are not longer than at rest have no force
};

/// Springs between consecutive particles: spring i joins particle i of `x_a` and particle i of `x_b`, 3 numbers a particle as in
/// Points.
struct SpringRun {
  const double* x_a;
  const double* x_b;
  const double* v_a;
  const double* v_b;
  double* force_a;  ///< null if not wanted
  double* force_b;  ///< null if not wanted
  Index count;      ///< kSimdWidth <= count <= kSpringBatch
};

/// Adds the springs' forces to `force_a` and subtracts them from `force_b`.
void add_run_forces(const SpringRun& run, const SpringConstants& constants);

/// Replaces each spring's difference of positions, first - second [m], by the force on its first end [N]. `velocity` holds the
/// differences of velocities [m/s]; both have 3 numbers a spring. Requires a count that is a multiple of kSimdWidth.
void differences_to_forces(double* difference, const double* velocity, Index count, const SpringConstants& constants);

}  // namespace sprung
