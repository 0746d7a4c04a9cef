// How many springs the kernels compute at a time.
#pragma once

#include "base/types.h"

namespace sprung {

inline constexpr Index kSpringLanes = 4;

}  // namespace sprung
