#include "base/kernel.h"
#include "dynamics/front_kernel.h"
#include "dynamics/lanes.h"

namespace sprung {
namespace {

constexpr Index kLanes = kSpringLanes;

template <class Number>
[[gnu::always_inline]] inline void solve(const FrontShape& shape, const Number* panel, Number* own, Number* below) {
  using Lanes = typename LanesOf<Number, kLanes>::Type;
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  for (Index t = 0; t < shape.own_tiles; ++t) {
    Lanes sum;
    load_lanes(own + t * kLanes, sum);
    for (Index k = 0; k < t * kLanes; ++k) {
      Lanes l;
      load_lanes(panel + t * stride + k * kLanes, l);
      sum -= l * own[k];
    }
    for (Index q = 0; q < kLanes; ++q) {
      Lanes l;
      load_lanes(panel + t * stride + (t * kLanes + q) * kLanes, l);
      sum -= l * sum[q];
    }
    store_lanes(sum, own + t * kLanes);
  }
  const Number* row = panel + shape.own_tiles * stride;
  for (Index t = 0; t < shape.lower_tiles; ++t, row += stride) {
    Lanes sums[kLanes] = {};
    for (Index k = 0; k < shape.width(); k += kLanes) {
      for (Index q = 0; q < kLanes; ++q) {
        Lanes l;
        load_lanes(row + (k + q) * kLanes, l);
        sums[q] += l * own[k + q];
      }
    }
    store_lanes((sums[0] + sums[1]) + (sums[2] + sums[3]), below + t * kLanes);
  }
}

// Each lane sums its own rows; lanes are added at the end.
template <class Number>
[[gnu::always_inline]] inline void solve_transposed(const FrontShape& shape, const Number* panel, const Number* inverse,
                                                    Number* own, const Number* below, Number* sums) {
  using Lanes = typename LanesOf<Number, kLanes>::Type;
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  for (Index k = 0; k < shape.width(); ++k) store_lanes(Lanes{}, sums + k * kLanes);
  const auto add_row = [&](const Number* row, const Number* x, Index columns) __attribute__((always_inline)) {
    Lanes right;
    load_lanes(x, right);
    for (Index k = 0; k < columns; ++k) {
      Lanes l;
      Lanes sum;
      load_lanes(row + k * kLanes, l);
      load_lanes(sums + k * kLanes, sum);
      sum += l * right;
      store_lanes(sum, sums + k * kLanes);
    }
  };
  for (Index t = 0; t < shape.lower_tiles; ++t) add_row(panel + (shape.own_tiles + t) * stride, below + t * kLanes, shape.width());
  for (Index t = shape.own_tiles - 1; t >= 0; --t) {
    for (Index q = kLanes - 1; q >= 0; --q) {
      const Index k = t * kLanes + q;
      const Number* const sum = sums + k * kLanes;
      Number inner = 0;
      for (Index p = q + 1; p < kLanes; ++p) inner += panel[t * stride + k * kLanes + p] * own[t * kLanes + p];
      own[k] = own[k] * inverse[k] - (((sum[0] + sum[1]) + (sum[2] + sum[3])) + inner);
    }
    add_row(panel + t * stride, own + t * kLanes, t * kLanes);
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
