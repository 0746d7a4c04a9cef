// Projection of springs onto their limits: the hot loop of StretchLimit.
#pragma once

#include "dynamics/stretch_batches.h"

namespace sprung {

/// Allowed lengths as parts of the rest length.
struct LengthRange {
  double least;
  double most;
};

/// Moves the ends of a part's springs by `relaxation` times what makes their lengths lie in `range`; `positions` holds 3 numbers a
/// particle [m]. Returns the largest excess before, as a part of the rest length.
double project_springs(const StretchBatches& batches, const StretchBatches::Part& part, const LengthRange& range, double relaxation,
                       double* positions);

/// The same excess; moves nothing.
double measure_springs(const StretchBatches& batches, const StretchBatches::Part& part, const LengthRange& range,
                       const double* positions);

}  // namespace sprung
