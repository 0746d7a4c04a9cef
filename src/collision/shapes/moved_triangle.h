// A triangle of a surface that deforms.
#pragma once

#include "base/types.h"

#include <array>

namespace sprung {

/// Its corners at an interval's begin and end [m].
struct MovedTriangle {
  std::array<Vector3, 3> before;
  std::array<Vector3, 3> after;
};

}  // namespace sprung
