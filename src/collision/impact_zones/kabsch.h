// The rotation that comes next to how points turned about their middle.
#pragma once

#include "base/types.h"

namespace sprung {

/// The rotation R with the least sum of w |R a - b|^2, of weights w and of points that went from a to b about their middles, given
/// the sum of w b a^T (Kabsch 1976). What the points say nothing about, as those of a line do about turns about it, it leaves.
[[nodiscard]] Matrix3 kabsch_rotation(const Matrix3& covariance);

}  // namespace sprung
