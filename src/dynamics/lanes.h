// Four numbers at a time, in whatever registers the machine has. For the .cpp files of kernels: functions that take these by value
// would have another ABI on each machine.
#pragma once

#include "dynamics/lane_count.h"

#include <cmath>

namespace sprung {

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using StoredLanes = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(alignof(double)), may_alias));

[[gnu::always_inline]] inline void load_lanes(const double* from, Lanes& to) { to = *reinterpret_cast<const StoredLanes*>(from); }
[[gnu::always_inline]] inline void store_lanes(const Lanes& from, double* to) { *reinterpret_cast<StoredLanes*>(to) = from; }

[[gnu::always_inline]] inline void square_root(Lanes& of) {
  for (Index lane = 0; lane < kLanes; ++lane) of[lane] = std::sqrt(of[lane]);
}

}  // namespace sprung
