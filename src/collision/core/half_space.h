// Half-spaces.
#pragma once

#include "base/types.h"

namespace sprung {

/// normal . x >= offset; unit normal.
struct HalfSpace {
  Vector3 normal = Vector3::Zero();
  double offset = 0.0;  ///< [m]
};

}  // namespace sprung
