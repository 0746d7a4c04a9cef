// Tiles of a front in SIMD registers. For the .cpp files of kernels alone, as simd.h.
#pragma once

#include "base/machine/simd.h"

namespace sprung {

inline constexpr Index kTile = kSimdWidth * kSimdWidth;

/// Four columns of `kVectors` registers of rows: one row of tiles if a register has four lanes, two if eight, four if sixteen.
/// Each number is computed in the same order whatever the width, so that the bits do not depend on it.
template <class Lanes, int kVectors>
struct Tiles {
  static constexpr int kRows = kVectors * kCountOf<Lanes> / kSimdWidth;
  static constexpr Index kHeight = kRows * kSimdWidth;
  Lanes column[kSimdWidth][kVectors];
};

template <class Lanes>
using HalfOf = typename SimdOf<NumberOf<Lanes>, kCountOf<Lanes> / 2>::Type;

/// Rows of tiles are `stride` numbers apart.
template <class Lanes>
[[gnu::always_inline]] inline void gather(const NumberOf<Lanes>* from, std::size_t stride, Lanes& to) {
  if constexpr (kCountOf<Lanes> == kSimdWidth) {
    load_simd(from, to);
  } else {
    HalfOf<Lanes> low;
    HalfOf<Lanes> high;
    gather(from, stride, low);
    gather(from + kCountOf<Lanes> / 2 / kSimdWidth * stride, stride, high);
    if constexpr (kCountOf<Lanes> == 8) {
      to = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      to = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void scatter(const Lanes& from, std::size_t stride, NumberOf<Lanes>* to) {
  if constexpr (kCountOf<Lanes> == kSimdWidth) {
    store_simd(from, to);
  } else {
    NumberOf<Lanes>* const second = to + kCountOf<Lanes> / 2 / kSimdWidth * stride;
    if constexpr (kCountOf<Lanes> == 8) {
      scatter<HalfOf<Lanes>>(__builtin_shufflevector(from, from, 0, 1, 2, 3), stride, to);
      scatter<HalfOf<Lanes>>(__builtin_shufflevector(from, from, 4, 5, 6, 7), stride, second);
    } else {
      scatter<HalfOf<Lanes>>(__builtin_shufflevector(from, from, 0, 1, 2, 3, 4, 5, 6, 7), stride, to);
      scatter<HalfOf<Lanes>>(__builtin_shufflevector(from, from, 8, 9, 10, 11, 12, 13, 14, 15), stride, second);
    }
  }
}

/// Where register v begins in rows of tiles that are `stride` numbers apart.
template <class Lanes>
[[gnu::always_inline]] inline std::size_t vector_begin(int v, std::size_t stride) {
  return static_cast<std::size_t>(v * (kCountOf<Lanes> / kSimdWidth)) * stride;
}

template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void gather_tiles(const NumberOf<Lanes>* from, std::size_t stride, Tiles<Lanes, kVectors>& to) {
  for (Index q = 0; q < kSimdWidth; ++q) {
    for (int v = 0; v < kVectors; ++v) gather(from + q * kSimdWidth + vector_begin<Lanes>(v, stride), stride, to.column[q][v]);
  }
}

template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void scatter_tiles(const Tiles<Lanes, kVectors>& from, std::size_t stride, NumberOf<Lanes>* to) {
  for (Index q = 0; q < kSimdWidth; ++q) {
    for (int v = 0; v < kVectors; ++v) scatter(from.column[q][v], stride, to + q * kSimdWidth + vector_begin<Lanes>(v, stride));
  }
}

/// Subtracts A B^T over `depth` columns. Columns of A are contiguous and hold all rows of the `Tiles`.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void subtract_product(const NumberOf<Lanes>* a, const NumberOf<Lanes>* b, Index depth,
                                                    Tiles<Lanes, kVectors>& from) {
  for (Index k = 0; k < depth; ++k) {
    Lanes left[kVectors];
    for (int v = 0; v < kVectors; ++v) load_simd(a + k * from.kHeight + v * kCountOf<Lanes>, left[v]);
    for (Index c = 0; c < kSimdWidth; ++c) {
      for (int v = 0; v < kVectors; ++v) from.column[c][v] -= left[v] * b[k * kSimdWidth + c];
    }
  }
}

}  // namespace sprung
