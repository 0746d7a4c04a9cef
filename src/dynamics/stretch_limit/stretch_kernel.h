// Projection of springs onto their limits: the hot loop of StretchLimit.
#pragma once

#include "base/kernel.h"
#include "dynamics/stretch_limit/spring_batches.h"

#include <algorithm>
#include <cmath>

namespace sprung {

/// Allowed lengths as parts of the rest length.
struct LengthRange {
  double least;
  double most;
};

/// Squares of the longest and the shortest length of some springs, as parts of the rest length.
struct SquaredLengths {
  double longest = 0.0;
  double shortest = HUGE_VAL;

  void include(const SquaredLengths& others) {
    longest = std::max(longest, others.longest);
    shortest = std::min(shortest, others.shortest);
  }

  /// How far they are beyond `range`, as a part of the rest length.
  [[nodiscard]] double excess(const LengthRange& range) const {
    return std::max({0.0, std::sqrt(longest) - range.most, range.least - std::sqrt(shortest)});
  }
};

/// Parts [begin, end) of batches.
struct Parts {
  Index begin;
  Index end;
};

/// Moves the ends of springs by `relaxation` times what makes their lengths lie in `range`, part after part; `positions` holds 3
/// numbers a particle [m]. Returns the lengths that it met. What is too short is pushed along what it was from end to end `before`,
/// where the step began, by at most that: what turns meanwhile is pushed short of its limit by the square of the angle, which
/// further passes take. Neither a push nor a pull has a direction where that has no length.
SquaredLengths project_springs_narrow(const SpringBatches& batches, const Parts& parts, const LengthRange& range, double relaxation,
                                      const double* before, double* positions);

/// Lengths of springs.
SquaredLengths measure_springs_narrow(const SpringBatches& batches, const Parts& parts, const double* positions);

/// The same bits, with twice as many lanes. Require has_wide_lanes().
SquaredLengths project_springs_wide(const SpringBatches& batches, const Parts& parts, const LengthRange& range, double relaxation,
                                    const double* before, double* positions);
SquaredLengths measure_springs_wide(const SpringBatches& batches, const Parts& parts, const double* positions);

/// Whichever the machine has.
inline SquaredLengths project_springs(const SpringBatches& batches, const Parts& parts, const LengthRange& range, double relaxation,
                                      const double* before, double* positions) {
  return (has_wide_lanes() ? project_springs_wide : project_springs_narrow)(batches, parts, range, relaxation, before, positions);
}
inline SquaredLengths measure_springs(const SpringBatches& batches, const Parts& parts, const double* positions) {
  return (has_wide_lanes() ? measure_springs_wide : measure_springs_narrow)(batches, parts, positions);
}

}  // namespace sprung
