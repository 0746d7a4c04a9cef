// Four vectors as they lie in memory, three registers for twelve numbers. For the .cpp files of kernels, as lanes.h.
//
// The compiler vectorises loops over x, y, z by itself too, but shuffles three times as much, and shuffles are what such loops wait
// for.
#pragma once

#include "dynamics/lanes.h"

namespace sprung {

struct Packed {
  SpringLanes low;     ///< x0 y0 z0 x1
  SpringLanes middle;  ///< y1 z1 x2 y2
  SpringLanes high;    ///< z2 x3 y3 z3
};

[[gnu::always_inline]] inline void load(const double* from, Packed& to) {
  load_lanes(from, to.low);
  load_lanes(from + kSpringLanes, to.middle);
  load_lanes(from + 2 * kSpringLanes, to.high);
}

[[gnu::always_inline]] inline void store(const Packed& from, double* to) {
  store_lanes(from.low, to);
  store_lanes(from.middle, to + kSpringLanes);
  store_lanes(from.high, to + 2 * kSpringLanes);
}

[[gnu::always_inline]] inline void subtract(const Packed& a, const Packed& b, Packed& to) {
  to.low = a.low - b.low;
  to.middle = a.middle - b.middle;
  to.high = a.high - b.high;
}

[[gnu::always_inline]] inline void unpack(const Packed& from, SpringLanes& x, SpringLanes& y, SpringLanes& z) {
  const SpringLanes xy = __builtin_shufflevector(from.low, from.middle, 0, 1, 6, 7);   // x0 y0 x2 y2
  const SpringLanes zx = __builtin_shufflevector(from.low, from.high, 2, 3, 4, 5);     // z0 x1 z2 x3
  const SpringLanes yz = __builtin_shufflevector(from.middle, from.high, 0, 1, 6, 7);  // y1 z1 y3 z3
  x = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
  y = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
  z = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
}

[[gnu::always_inline]] inline void pack(const SpringLanes& x, const SpringLanes& y, const SpringLanes& z, Packed& to) {
  const SpringLanes xy = __builtin_shufflevector(x, y, 0, 4, 2, 6);  // x0 y0 x2 y2
  const SpringLanes zx = __builtin_shufflevector(z, x, 0, 5, 2, 7);  // z0 x1 z2 x3
  const SpringLanes yz = __builtin_shufflevector(y, z, 1, 5, 3, 7);  // y1 z1 y3 z3
  to.low = __builtin_shufflevector(xy, zx, 0, 1, 4, 5);
  to.middle = __builtin_shufflevector(yz, xy, 0, 1, 6, 7);
  to.high = __builtin_shufflevector(zx, yz, 2, 3, 6, 7);
}

/// Each vector times its own number.
[[gnu::always_inline]] inline void multiply(Packed& vectors, const SpringLanes& scale) {
  vectors.low *= __builtin_shufflevector(scale, scale, 0, 0, 0, 1);
  vectors.middle *= __builtin_shufflevector(scale, scale, 1, 1, 2, 2);
  vectors.high *= __builtin_shufflevector(scale, scale, 2, 3, 3, 3);
}

}  // namespace sprung
