#include "dynamics/front_kernel.h"

#include "base/kernel.h"
#include "dynamics/lanes.h"

namespace sprung {
namespace {

constexpr Index kLanes = kSpringLanes;
constexpr Index kTile = kLanes * kLanes;

/// Tiles in the same columns of kRows rows of tiles, which lie `stride` numbers apart.
template <int kRows>
struct Tiles {
  SpringLanes column[kRows][kLanes];
};

template <int kRows>
[[gnu::always_inline]] inline void load_tiles(const double* from, std::size_t row_stride, std::size_t column_stride,
                                              Tiles<kRows>& to) {
  for (int r = 0; r < kRows; ++r) {
    for (Index c = 0; c < kLanes; ++c) load_lanes(from + r * row_stride + c * column_stride, to.column[r][c]);
  }
}

template <int kRows>
[[gnu::always_inline]] inline void store_tiles(const Tiles<kRows>& from, std::size_t row_stride, std::size_t column_stride,
                                               double* to) {
  for (int r = 0; r < kRows; ++r) {
    for (Index c = 0; c < kLanes; ++c) store_lanes(from.column[r][c], to + r * row_stride + c * column_stride);
  }
}

/// Subtracts A B^T of `depth` columns.
template <int kRows>
[[gnu::always_inline]] inline void subtract_product(const double* a, std::size_t stride, const double* b, Index depth,
                                                    Tiles<kRows>& from) {
  for (Index k = 0; k < depth; ++k) {
    SpringLanes left[kRows];
    for (int r = 0; r < kRows; ++r) load_lanes(a + r * stride + k * kLanes, left[r]);
    for (Index c = 0; c < kLanes; ++c) {
      for (int r = 0; r < kRows; ++r) from.column[r][c] -= left[r] * b[k * kLanes + c];
    }
  }
}

/// Rows of L D from those of the matrix, left of tile column `columns`: what the columns before have in them is taken out.
template <int kRows>
[[gnu::always_inline]] inline void solve_rows(const double* panel, std::size_t stride, const double* from, Index columns,
                                              double* row) {
  for (Index c = 0; c < columns; ++c) {
    const double* const diagonal = panel + c * stride;
    Tiles<kRows> tiles;
    load_tiles(from + c * kTile, stride, kLanes, tiles);
    subtract_product(row, stride, diagonal, c * kLanes, tiles);
    for (Index q = 1; q < kLanes; ++q) {
      for (Index p = 0; p < q; ++p) {
        const double l = diagonal[c * kTile + p * kLanes + q];
        for (int r = 0; r < kRows; ++r) tiles.column[r][q] -= tiles.column[r][p] * l;
      }
    }
    store_tiles(tiles, stride, kLanes, row + c * kTile);
  }
}

/// Rows of L from those of L D.
template <int kRows>
[[gnu::always_inline]] inline void scale_rows(const double* row, std::size_t stride, const double* inverse, Index columns,
                                              double* to) {
  for (int r = 0; r < kRows; ++r) {
    for (Index k = 0; k < columns * kLanes; ++k) {
      SpringLanes lanes;
      load_lanes(row + r * stride + k * kLanes, lanes);
      lanes *= inverse[k];
      store_lanes(lanes, to + r * stride + k * kLanes);
    }
  }
}

/// L D L^T of a tile on the diagonal.
[[gnu::always_inline]] inline bool eliminate_tile(Tiles<1>& tile, double* inverse) {
  bool positive = true;
  for (Index q = 0; q < kLanes; ++q) {
    SpringLanes& column = tile.column[0][q];
    positive = positive && column[q] > 0.0;
    inverse[q] = 1.0 / column[q];
    const SpringLanes scaled = column * inverse[q];
    for (Index p = q + 1; p < kLanes; ++p) tile.column[0][p] -= column * scaled[p];
    column = scaled;
    for (Index lane = 0; lane <= q; ++lane) column[lane] = 0.0;
  }
  return positive;
}

[[gnu::always_inline]] inline bool eliminate_own(const FrontShape& shape, std::size_t stride, double* panel, double* inverse,
                                                 double* row) {
  for (Index t = 0; t < shape.own_tiles; ++t) {
    double* const own = panel + t * stride;
    solve_rows<1>(panel, stride, own, t, row);
    scale_rows<1>(row, stride, inverse, t, own);
    Tiles<1> diagonal;
    load_tiles(own + t * kTile, stride, kLanes, diagonal);
    subtract_product(row, stride, own, t * kLanes, diagonal);
    if (!eliminate_tile(diagonal, inverse + t * kLanes)) return false;
    store_tiles(diagonal, stride, kLanes, own + t * kTile);
  }
  return true;
}

/// Rows below, from tile `t` on, and what they hand on.
template <int kRows>
[[gnu::always_inline]] inline void eliminate_lower(const FrontShape& shape, std::size_t stride, Index t, double* panel,
                                                   const double* inverse, double* update, double* row) {
  double* const lower = panel + shape.own_tiles * stride;
  solve_rows<kRows>(panel, stride, lower + t * stride, shape.own_tiles, row);
  scale_rows<kRows>(row, stride, inverse, shape.own_tiles, lower + t * stride);
  const auto height = static_cast<std::size_t>(shape.lower_height());
  for (Index s = 0; s < t + kRows; ++s) {
    Tiles<kRows> tiles;
    double* const at = update + s * kLanes * height + t * kLanes;
    load_tiles(at, kLanes, height, tiles);
    subtract_product(row, stride, lower + s * stride, shape.width(), tiles);
    store_tiles(tiles, kLanes, height, at);
  }
}

}  // namespace

SPRUNG_KERNEL bool eliminate_front(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  if (!eliminate_own(shape, stride, panel, inverse, row)) return false;
  Index t = 0;
  for (; t + 2 <= shape.lower_tiles; t += 2) eliminate_lower<2>(shape, stride, t, panel, inverse, update, row);
  if (t < shape.lower_tiles) eliminate_lower<1>(shape, stride, t, panel, inverse, update, row);
  return true;
}

SPRUNG_KERNEL void add_update(std::span<const Index> rows, std::span<const RowRun> runs, const double* child, Index child_height,
                              const FrontShape& shape, double* panel, double* update) {
  const auto from_height = static_cast<std::size_t>(child_height);
  const std::size_t own = runs.empty() ? rows.size() : static_cast<std::size_t>(runs.front().from) / 3;
  for (std::size_t j = 0; j < 3 * own; ++j) {
    const double* const from = child + j * from_height;
    const Index column = rows[j / 3] + static_cast<Index>(j % 3);
    for (std::size_t r = j % 3; r < 3; ++r) panel[shape.place(rows[j / 3] + static_cast<Index>(r), column)] += from[j - j % 3 + r];
    for (std::size_t i = j / 3 + 1; i < rows.size(); ++i) {
      for (std::size_t r = 0; r < 3; ++r) panel[shape.place(rows[i] + static_cast<Index>(r), column)] += from[3 * i + r];
    }
  }
  const auto to_height = static_cast<std::size_t>(shape.lower_height());
  for (std::size_t first = 0; first < runs.size(); ++first) {
    for (Index q = 0; q < runs[first].length; ++q) {
      const double* const from = child + static_cast<std::size_t>(runs[first].from + q) * from_height;
      double* const to = update + static_cast<std::size_t>(runs[first].to + q) * to_height;
      for (Index k = q; k < runs[first].length; ++k) to[runs[first].to + k] += from[runs[first].from + k];
      for (const RowRun& run : runs.subspan(first + 1)) {
        for (Index k = 0; k < run.length; ++k) to[run.to + k] += from[run.from + k];
      }
    }
  }
}

SPRUNG_KERNEL void solve_front(const FrontShape& shape, const double* panel, double* own, double* below) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  for (Index t = 0; t < shape.own_tiles; ++t) {
    SpringLanes sum;
    load_lanes(own + t * kLanes, sum);
    for (Index k = 0; k < t * kLanes; ++k) {
      SpringLanes l;
      load_lanes(panel + t * stride + k * kLanes, l);
      sum -= l * own[k];
    }
    for (Index q = 0; q < kLanes; ++q) {
      SpringLanes l;
      load_lanes(panel + t * stride + (t * kLanes + q) * kLanes, l);
      sum -= l * sum[q];
    }
    store_lanes(sum, own + t * kLanes);
  }
  const double* row = panel + shape.own_tiles * stride;
  for (Index t = 0; t < shape.lower_tiles; ++t, row += stride) {
    SpringLanes sums[kLanes] = {};
    for (Index k = 0; k < shape.width(); k += kLanes) {
      for (Index q = 0; q < kLanes; ++q) {
        SpringLanes l;
        load_lanes(row + (k + q) * kLanes, l);
        sums[q] += l * own[k + q];
      }
    }
    store_lanes((sums[0] + sums[1]) + (sums[2] + sums[3]), below + t * kLanes);
  }
}

// Each lane sums its own rows; lanes are added at the end.
SPRUNG_KERNEL void solve_front_transposed(const FrontShape& shape, const double* panel, const double* inverse, double* own,
                                          const double* below, double* sums) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  for (Index k = 0; k < shape.width(); ++k) store_lanes(SpringLanes{}, sums + k * kLanes);
  const auto add_row = [&](const double* row, const double* x, Index columns) __attribute__((always_inline)) {
    SpringLanes right;
    load_lanes(x, right);
    for (Index k = 0; k < columns; ++k) {
      SpringLanes l;
      SpringLanes sum;
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
      const double* const sum = sums + k * kLanes;
      double inner = 0.0;
      for (Index p = q + 1; p < kLanes; ++p) inner += panel[t * stride + k * kLanes + p] * own[t * kLanes + p];
      own[k] = own[k] * inverse[k] - (((sum[0] + sum[1]) + (sum[2] + sum[3])) + inner);
    }
    add_row(panel + t * stride, own + t * kLanes, t * kLanes);
  }
}

}  // namespace sprung
