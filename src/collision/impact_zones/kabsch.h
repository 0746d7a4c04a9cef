// Best rotation between two point sets (Kabsch 1976).
#pragma once

#include "base/types.h"

namespace sprung {

/// The rotation R that minimises the sum of w |R a - b|^2 over points a and b, relative to their centroids, with weights w.
/// Requires `covariance`, the sum of w b a^T. Collinear points do not determine the rotation about their line; R then does not
/// rotate about it.
[[nodiscard]] Matrix3 kabsch_rotation(const Matrix3& covariance);

}  // namespace sprung
