// Four numbers at a time, in whatever registers the machine has. For the .cpp files of kernels: functions that take these by value
// would have another ABI on each machine.
#pragma once

#include "dynamics/lane_count.h"

#include <cmath>

namespace sprung {

using SpringLanes = double __attribute__((vector_size(kSpringLanes * sizeof(double))));
using StoredSpringLanes = double __attribute__((vector_size(kSpringLanes * sizeof(double)), aligned(alignof(double)), may_alias));

[[gnu::always_inline]] inline void load_lanes(const double* from, SpringLanes& to) {
  to = *reinterpret_cast<const StoredSpringLanes*>(from);
}
[[gnu::always_inline]] inline void store_lanes(const SpringLanes& from, double* to) {
  *reinterpret_cast<StoredSpringLanes*>(to) = from;
}

[[gnu::always_inline]] inline void square_root(SpringLanes& of) {
  for (Index lane = 0; lane < kSpringLanes; ++lane) of[lane] = std::sqrt(of[lane]);
}

}  // namespace sprung
