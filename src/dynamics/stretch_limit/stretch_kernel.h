// Projection of springs onto their limits: the inner loop of StretchLimit.
#pragma once

#include "base/machine/kernel.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <algorithm>
#include <cmath>

namespace sprung {

/// Allowed lengths relative to the rest length.
struct LengthRange {
  double least;
  double most;
};

/// Squares of the largest and the smallest length of some springs, relative to the rest length.
struct SquaredLengths {
  double longest = 0.0;
  double shortest = HUGE_VAL;

  void include(const SquaredLengths& others) {
    longest = std::max(longest, others.longest);
    shortest = std::min(shortest, others.shortest);
  }

  /// The largest excess beyond `range`, relative to the rest length.
  [[nodiscard]] double excess(const LengthRange& range) const {
    return std::max({0.0, std::sqrt(longest) - range.most, range.least - std::sqrt(shortest)});
  }
};

/// Batches [begin, end).
struct BatchRange {
  Index begin;
  Index end;
};

/// Projects springs onto `range`, batch after batch: moves their ends by `relaxation` times the correction. `positions` [m] holds
/// 3 numbers a particle. Returns the lengths before the projection. A spring that is too short is pushed along its vector `before`
/// the step, by at most its length. If it rotated meanwhile, the push falls short by the square of the angle, which further passes
/// correct. A spring whose vector has no length is not moved.
SquaredLengths project_springs_narrow(const SpringBatches& batches, const BatchRange& batch_range, const LengthRange& range,
                                      double relaxation, const double* before, double* positions);

/// Measures the lengths of springs.
SquaredLengths measure_springs_narrow(const SpringBatches& batches, const BatchRange& batch_range, const double* positions);

/// The same bits with registers twice as wide. Require has_wide_lanes().
SquaredLengths project_springs_wide(const SpringBatches& batches, const BatchRange& batch_range, const LengthRange& range,
                                    double relaxation, const double* before, double* positions);
SquaredLengths measure_springs_wide(const SpringBatches& batches, const BatchRange& batch_range, const double* positions);

/// Chooses the version for this machine.
inline SquaredLengths project_springs(const SpringBatches& batches, const BatchRange& batch_range, const LengthRange& range,
                                      double relaxation, const double* before, double* positions) {
  return (has_wide_lanes() ? project_springs_wide : project_springs_narrow)(batches, batch_range, range, relaxation, before,
                                                                            positions);
}
inline SquaredLengths measure_springs(const SpringBatches& batches, const BatchRange& batch_range, const double* positions) {
  return (has_wide_lanes() ? measure_springs_wide : measure_springs_narrow)(batches, batch_range, positions);
}

}  // namespace sprung
