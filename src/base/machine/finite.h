// Tests many numbers for NaN and infinity at once.
#pragma once

#include "base/types.h"

namespace sprung {

/// Whether all `count` numbers from `values` on are finite.
[[nodiscard]] bool are_finite(const double* values, Index count);

}  // namespace sprung
