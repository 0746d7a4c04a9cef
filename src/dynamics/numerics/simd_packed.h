// Four or eight 3-vectors as they lie in memory: three registers for twelve or twenty-four numbers. For the .cpp files of kernels
// alone, as simd.h.
//
// The compiler also vectorises loops over x, y, z, but with three times as many shuffles, and shuffles bound these loops.
#pragma once

#include "base/machine/simd.h"

namespace sprung {

template <class L>
struct PackedSimd {
  using Lanes = L;

  Lanes low;     ///< four vectors: x0 y0 z0 x1; eight: x0 y0 z0 ... x2 y2
  Lanes middle;  ///< y1 z1 x2 y2; z2 x3 ... z4 x5
  Lanes high;    ///< z2 x3 y3 z3; y5 z5 ... y7 z7
};
using PackedVectors4 = PackedSimd<Double4>;
using PackedVectors8 = PackedSimd<Double8>;

template <class Lanes>
[[gnu::always_inline]] inline void load(const double* from, PackedSimd<Lanes>& to) {
  load_simd(from, to.low);
  load_simd(from + kCountOf<Lanes>, to.middle);
  load_simd(from + 2 * kCountOf<Lanes>, to.high);
}

template <class Lanes>
[[gnu::always_inline]] inline void store(const PackedSimd<Lanes>& from, double* to) {
  store_simd(from.low, to);
  store_simd(from.middle, to + kCountOf<Lanes>);
  store_simd(from.high, to + 2 * kCountOf<Lanes>);
}

template <class Lanes>
[[gnu::always_inline]] inline void add(const PackedSimd<Lanes>& a, const PackedSimd<Lanes>& b, PackedSimd<Lanes>& to) {
  to.low = a.low + b.low;
  to.middle = a.middle + b.middle;
  to.high = a.high + b.high;
}

template <class Lanes>
[[gnu::always_inline]] inline void subtract(const PackedSimd<Lanes>& a, const PackedSimd<Lanes>& b, PackedSimd<Lanes>& to) {
  to.low = a.low - b.low;
  to.middle = a.middle - b.middle;
  to.high = a.high - b.high;
}

template <class Lanes>
[[gnu::always_inline]] inline void square(PackedSimd<Lanes>& numbers) {
  numbers.low *= numbers.low;
  numbers.middle *= numbers.middle;
  numbers.high *= numbers.high;
}

[[gnu::always_inline]] inline void unpack(const PackedVectors4& from, Double4& x, Double4& y, Double4& z) {
  const Double4 xy = __builtin_shufflevector(from.low, from.middle, 0, 1, 6, 7);   // x0 y0 x2 y2
  const Double4 zx = __builtin_shufflevector(from.low, from.high, 2, 3, 4, 5);     // z0 x1 z2 x3
  const Double4 yz = __builtin_shufflevector(from.middle, from.high, 0, 1, 6, 7);  // y1 z1 y3 z3
  x = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
  y = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
  z = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
}

[[gnu::always_inline]] inline void unpack(const PackedVectors8& from, Double8& x, Double8& y, Double8& z) {
  x = __builtin_shufflevector(from.low, from.middle, 0, 3, 6, 9, 12, 15, 15, 15);
  y = __builtin_shufflevector(from.low, from.middle, 1, 4, 7, 10, 13, 13, 13, 13);
  z = __builtin_shufflevector(from.low, from.middle, 2, 5, 8, 11, 14, 14, 14, 14);
  x = __builtin_shufflevector(x, from.high, 0, 1, 2, 3, 4, 5, 10, 13);
  y = __builtin_shufflevector(y, from.high, 0, 1, 2, 3, 4, 8, 11, 14);
  z = __builtin_shufflevector(z, from.high, 0, 1, 2, 3, 4, 9, 12, 15);
}

/// Multiplies each vector by its own number.
[[gnu::always_inline]] inline void multiply(PackedVectors4& vectors, const Double4& scale) {
  vectors.low *= __builtin_shufflevector(scale, scale, 0, 0, 0, 1);
  vectors.middle *= __builtin_shufflevector(scale, scale, 1, 1, 2, 2);
  vectors.high *= __builtin_shufflevector(scale, scale, 2, 3, 3, 3);
}

[[gnu::always_inline]] inline void multiply(PackedVectors8& vectors, const Double8& scale) {
  vectors.low *= __builtin_shufflevector(scale, scale, 0, 0, 0, 1, 1, 1, 2, 2);
  vectors.middle *= __builtin_shufflevector(scale, scale, 2, 3, 3, 3, 4, 4, 4, 5);
  vectors.high *= __builtin_shufflevector(scale, scale, 5, 5, 6, 6, 6, 7, 7, 7);
}

/// Loads the successor of each vector; the successor of the last one is undefined. `from` is where the vectors lie.
[[gnu::always_inline]] inline void load_next(const double* from, const PackedVectors4& vectors, PackedVectors4& next) {
  load_simd(from + 3, next.low);
  load_simd(from + 7, next.middle);
  next.high = __builtin_shufflevector(vectors.high, vectors.high, 3, 3, 3, 3);
}

[[gnu::always_inline]] inline void load_next(const double* from, const PackedVectors8& vectors, PackedVectors8& next) {
  load_simd(from + 3, next.low);
  load_simd(from + 11, next.middle);
  next.high = __builtin_shufflevector(vectors.high, vectors.high, 3, 4, 5, 6, 7, 7, 7, 7);
}

/// Swaps vectors 0 and 1, 2 and 3, and so on.
[[gnu::always_inline]] inline void swap_neighbours(const PackedVectors4& from, PackedVectors4& to) {
  to.low = __builtin_shufflevector(from.low, from.middle, 3, 4, 5, 0);
  to.middle = __builtin_shufflevector(from.low, from.high, 1, 2, 5, 6);
  to.high = __builtin_shufflevector(from.high, from.middle, 3, 6, 7, 0);
}

[[gnu::always_inline]] inline void swap_neighbours(const PackedVectors8& from, PackedVectors8& to) {
  to.low = __builtin_shufflevector(from.low, from.middle, 3, 4, 5, 0, 1, 2, 9, 10);
  const Double8 without_y5_z5 = __builtin_shufflevector(from.middle, from.low, 3, 14, 15, 0, 7, 7, 7, 4);
  to.middle = __builtin_shufflevector(without_y5_z5, from.high, 0, 1, 2, 3, 4, 8, 9, 7);
  to.high = __builtin_shufflevector(from.high, from.middle, 13, 14, 5, 6, 7, 2, 3, 4);
}

}  // namespace sprung
