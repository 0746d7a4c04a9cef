// Spring-damper forces of short batches of springs: the hot loop of SpringForce.
#pragma once

#include "base/simd.h"

namespace sprung {

/// Springs a batch holds at most: few enough for its buffers to stay in the first-level cache.
inline constexpr Index kSpringBatch = 64;

/// A constant of the springs of a batch: an entry a spring, or kSimdWidth equal ones for all.
struct SpringConstant {
  const double* values;
  bool same;

  [[nodiscard]] const double* at(Index i) const { return same ? values : values + i; }
};

struct SpringConstants {
  SpringConstant rest_length;
  SpringConstant stiffness;
  SpringConstant damping;
};

/// Springs whose ends are consecutive particles: spring i joins particle i of `x_a` and of `x_b` (3 numbers a particle, as Points).
struct SpringRun {
  const double* x_a;
  const double* x_b;
  const double* v_a;
  const double* v_b;
  double* force_a;  ///< null when not wanted
  double* force_b;  ///< null when not wanted
  Index count;      ///< kSimdWidth <= count <= kSpringBatch
};

/// Adds the springs' forces to `force_a` and subtracts them from `force_b`.
void add_run_forces(const SpringRun& run, const SpringConstants& constants);

/// Forces on the first ends of springs whose differences first - second of positions [m] and velocities [m/s] are given, 3 numbers
/// a spring; written over `difference`. Requires a count that is a multiple of kSimdWidth.
void differences_to_forces(double* difference, const double* velocity, Index count, const SpringConstants& constants);

}  // namespace sprung
