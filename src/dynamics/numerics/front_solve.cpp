#include "base/machine/kernel.h"
#include "base/machine/simd.h"
#include "dynamics/numerics/front_kernel.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr Index kTile = kSimdWidth * kSimdWidth;

/// Subtracts L of some rows of tiles, `stride` numbers apart, times the first `columns` numbers of a vector.
template <Index kRows, class Lanes>
[[gnu::always_inline]] inline void subtract_rows(const NumberOf<Lanes>* rows, std::size_t stride, Index columns,
                                                 const NumberOf<Lanes>* x, Lanes (&from)[kRows]) {
  for (Index k = 0; k < columns; ++k) {
    for (Index r = 0; r < kRows; ++r) {
      Lanes l;
      load_simd(rows + r * stride + k * kSimdWidth, l);
      from[r] -= l * x[k];
    }
  }
}

/// Solves for kRows rows of tiles from `t` on. Requires that the rows before are solved.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void solve_own(const Number* panel, std::size_t stride, Index& t, Index tiles, Number* own) {
  using Lanes = typename SimdOf<Number, kSimdWidth>::Type;
  for (; t + kRows <= tiles; t += kRows) {
    const Number* const rows = panel + t * stride;
    Lanes sums[kRows];
    for (Index r = 0; r < kRows; ++r) load_simd(own + (t + r) * kSimdWidth, sums[r]);
    subtract_rows(rows, stride, t * kSimdWidth, own, sums);
    for (Index r = 0; r < kRows; ++r) {
      Lanes one[1] = {sums[r]};
      subtract_rows(rows + r * stride + t * kTile, stride, r * kSimdWidth, own + t * kSimdWidth, one);
      Lanes sum = one[0];
      for (Index q = 0; q < kSimdWidth; ++q) {
        Lanes l;
        load_simd(rows + r * stride + ((t + r) * kSimdWidth + q) * kSimdWidth, l);
        sum -= l * sum[q];
      }
      store_simd(sum, own + (t + r) * kSimdWidth);
    }
  }
}

/// Writes L of kRows rows of tiles times the front's own slice.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void multiply_lower(const Number* lower, std::size_t stride, Index& t, Index tiles, Index width,
                                                  const Number* own, Number* below) {
  using Lanes = typename SimdOf<Number, kSimdWidth>::Type;
  for (; t + kRows <= tiles; t += kRows) {
    const Number* const rows = lower + t * stride;
    Lanes sums[kRows][kSimdWidth] = {};
    for (Index k = 0; k < width; k += kSimdWidth) {
      for (Index q = 0; q < kSimdWidth; ++q) {
        for (Index r = 0; r < kRows; ++r) {
          Lanes l;
          load_simd(rows + r * stride + (k + q) * kSimdWidth, l);
          sums[r][q] += l * own[k + q];
        }
      }
    }
    for (Index r = 0; r < kRows; ++r) {
      store_simd((sums[r][0] + sums[r][1]) + (sums[r][2] + sums[r][3]), below + (t + r) * kSimdWidth);
    }
  }
}

template <class Number>
[[gnu::always_inline]] inline void solve(const FrontShape& shape, const Number* panel, Number* own, Number* below) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kSimdWidth;
  Index t = 0;
  solve_own<4>(panel, stride, t, shape.own_tiles, own);
  solve_own<1>(panel, stride, t, shape.own_tiles, own);
  const Number* const lower = panel + shape.own_tiles * stride;
  t = 0;
  multiply_lower<2>(lower, stride, t, shape.lower_tiles, shape.width(), own, below);
  multiply_lower<1>(lower, stride, t, shape.lower_tiles, shape.width(), own, below);
}

/// Adds kRows rows of tiles, transposed, times x to the sums of each lane and column, row after row.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void add_transposed(const Number* rows, std::size_t stride, Index columns, const Number* x,
                                                  Number* sums) {
  constexpr Index kCount = sizeof(Double4) / sizeof(Number);
  using Lanes = typename SimdOf<Number, kCount>::Type;
  Lanes right[kRows];
  for (Index r = 0; r < kRows; ++r) {
    for (Index lane = 0; lane < kCount; ++lane) right[r][lane] = x[r * kSimdWidth + lane % kSimdWidth];
  }
  for (Index k = 0; k < columns * kSimdWidth; k += kCount) {
    Lanes sum;
    load_simd(sums + k, sum);
    for (Index r = 0; r < kRows; ++r) {
      Lanes l;
      load_simd(rows + r * stride + k, l);
      sum += l * right[r];
    }
    store_simd(sum, sums + k);
  }
}

// Each lane sums its own rows; the lanes are added at the end.
template <class Number>
[[gnu::always_inline]] inline void solve_transposed(const FrontShape& shape, const Number* panel, const Number* inverse,
                                                    Number* own, const Number* below, Number* sums) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kSimdWidth;
  std::fill_n(sums, stride, Number{});
  const Number* const lower = panel + shape.own_tiles * stride;
  Index r = 0;
  for (; r + 4 <= shape.lower_tiles; r += 4)
    add_transposed<4>(lower + r * stride, stride, shape.width(), below + r * kSimdWidth, sums);
  for (; r < shape.lower_tiles; ++r) add_transposed<1>(lower + r * stride, stride, shape.width(), below + r * kSimdWidth, sums);
  for (Index t = shape.own_tiles - 1; t >= 0; --t) {
    for (Index q = kSimdWidth - 1; q >= 0; --q) {
      const Index k = t * kSimdWidth + q;
      const Number* const sum = sums + k * kSimdWidth;
      Number inner = 0;
      for (Index p = q + 1; p < kSimdWidth; ++p) inner += panel[t * stride + k * kSimdWidth + p] * own[t * kSimdWidth + p];
      own[k] = own[k] * inverse[k] - (((sum[0] + sum[1]) + (sum[2] + sum[3])) + inner);
    }
    add_transposed<1>(panel + t * stride, stride, t * kSimdWidth, own + t * kSimdWidth, sums);
  }
}

}  // namespace

SPRUNG_KERNEL void solve_front(const FrontShape& shape, const double* panel, double* own, double* below) {
  solve(shape, panel, own, below);
}
SPRUNG_KERNEL void solve_front(const FrontShape& shape, const float* panel, float* own, float* below) {
  solve(shape, panel, own, below);
}

SPRUNG_KERNEL void solve_front_transposed(const FrontShape& shape, const double* panel, const double* inverse, double* own,
                                          const double* below, double* sums) {
  solve_transposed(shape, panel, inverse, own, below, sums);
}
SPRUNG_KERNEL void solve_front_transposed(const FrontShape& shape, const float* panel, const float* inverse, float* own,
                                          const float* below, float* sums) {
  solve_transposed(shape, panel, inverse, own, below, sums);
}

}  // namespace sprung
