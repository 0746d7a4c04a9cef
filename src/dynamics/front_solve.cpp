#include "base/kernel.h"
#include "dynamics/front_kernel.h"
#include "dynamics/lanes.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr Index kLanes = kSpringLanes;
constexpr Index kTile = kLanes * kLanes;

/// Subtracts L of some rows of tiles, `stride` numbers apart, times a vector's first `columns` numbers.
template <Index kRows, class Lanes>
[[gnu::always_inline]] inline void subtract_rows(const NumberOf<Lanes>* rows, std::size_t stride, Index columns,
                                                 const NumberOf<Lanes>* x, Lanes (&from)[kRows]) {
  for (Index k = 0; k < columns; ++k) {
    for (Index r = 0; r < kRows; ++r) {
      Lanes l;
      load_lanes(rows + r * stride + k * kLanes, l);
      from[r] -= l * x[k];
    }
  }
}

/// Solves for kRows rows of tiles from `t` on, those before being solved.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void solve_own(const Number* panel, std::size_t stride, Index& t, Index tiles, Number* own) {
  using Lanes = typename LanesOf<Number, kLanes>::Type;
  for (; t + kRows <= tiles; t += kRows) {
    const Number* const rows = panel + t * stride;
    Lanes sums[kRows];
    for (Index r = 0; r < kRows; ++r) load_lanes(own + (t + r) * kLanes, sums[r]);
    subtract_rows(rows, stride, t * kLanes, own, sums);
    for (Index r = 0; r < kRows; ++r) {
      Lanes one[1] = {sums[r]};
      subtract_rows(rows + r * stride + t * kTile, stride, r * kLanes, own + t * kLanes, one);
      Lanes sum = one[0];
      for (Index q = 0; q < kLanes; ++q) {
        Lanes l;
        load_lanes(rows + r * stride + ((t + r) * kLanes + q) * kLanes, l);
        sum -= l * sum[q];
      }
      store_lanes(sum, own + (t + r) * kLanes);
    }
  }
}

/// Writes L of kRows rows of tiles times the front's own part.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void multiply_lower(const Number* lower, std::size_t stride, Index& t, Index tiles, Index width,
                                                  const Number* own, Number* below) {
  using Lanes = typename LanesOf<Number, kLanes>::Type;
  for (; t + kRows <= tiles; t += kRows) {
    const Number* const rows = lower + t * stride;
    Lanes sums[kRows][kLanes] = {};
    for (Index k = 0; k < width; k += kLanes) {
      for (Index q = 0; q < kLanes; ++q) {
        for (Index r = 0; r < kRows; ++r) {
          Lanes l;
          load_lanes(rows + r * stride + (k + q) * kLanes, l);
          sums[r][q] += l * own[k + q];
        }
      }
    }
    for (Index r = 0; r < kRows; ++r) {
      store_lanes((sums[r][0] + sums[r][1]) + (sums[r][2] + sums[r][3]), below + (t + r) * kLanes);
    }
  }
}

template <class Number>
[[gnu::always_inline]] inline void solve(const FrontShape& shape, const Number* panel, Number* own, Number* below) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  Index t = 0;
  solve_own<4>(panel, stride, t, shape.own_tiles, own);
  solve_own<1>(panel, stride, t, shape.own_tiles, own);
  const Number* const lower = panel + shape.own_tiles * stride;
  t = 0;
  multiply_lower<2>(lower, stride, t, shape.lower_tiles, shape.width(), own, below);
  multiply_lower<1>(lower, stride, t, shape.lower_tiles, shape.width(), own, below);
}

/// Adds kRows rows of tiles, transposed, times x to what each lane sums of each column, row after row.
template <Index kRows, class Number>
[[gnu::always_inline]] inline void add_transposed(const Number* rows, std::size_t stride, Index columns, const Number* x,
                                                  Number* sums) {
  constexpr Index kCount = sizeof(SpringLanes) / sizeof(Number);
  using Lanes = typename LanesOf<Number, kCount>::Type;
  Lanes right[kRows];
  for (Index r = 0; r < kRows; ++r) {
    for (Index lane = 0; lane < kCount; ++lane) right[r][lane] = x[r * kLanes + lane % kLanes];
  }
  for (Index k = 0; k < columns * kLanes; k += kCount) {
    Lanes sum;
    load_lanes(sums + k, sum);
    for (Index r = 0; r < kRows; ++r) {
      Lanes l;
      load_lanes(rows + r * stride + k, l);
      sum += l * right[r];
    }
    store_lanes(sum, sums + k);
  }
}

// Each lane sums its own rows; lanes are added at the end.
template <class Number>
[[gnu::always_inline]] inline void solve_transposed(const FrontShape& shape, const Number* panel, const Number* inverse,
                                                    Number* own, const Number* below, Number* sums) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  std::fill_n(sums, stride, Number{});
  const Number* const lower = panel + shape.own_tiles * stride;
  Index r = 0;
  for (; r + 4 <= shape.lower_tiles; r += 4) add_transposed<4>(lower + r * stride, stride, shape.width(), below + r * kLanes, sums);
  for (; r < shape.lower_tiles; ++r) add_transposed<1>(lower + r * stride, stride, shape.width(), below + r * kLanes, sums);
  for (Index t = shape.own_tiles - 1; t >= 0; --t) {
    for (Index q = kLanes - 1; q >= 0; --q) {
      const Index k = t * kLanes + q;
      const Number* const sum = sums + k * kLanes;
      Number inner = 0;
      for (Index p = q + 1; p < kLanes; ++p) inner += panel[t * stride + k * kLanes + p] * own[t * kLanes + p];
      own[k] = own[k] * inverse[k] - (((sum[0] + sum[1]) + (sum[2] + sum[3])) + inner);
    }
    add_transposed<1>(panel + t * stride, stride, t * kLanes, own + t * kLanes, sums);
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
