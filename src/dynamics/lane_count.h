// How many springs the kernels compute at a time.
#pragma once

#include "base/types.h"

namespace sprung {

inline constexpr Index kSpringLanes = 4;
inline constexpr Index kWideLanes = 8;  ///< where a kernel has a version for AVX-512

}  // namespace sprung
