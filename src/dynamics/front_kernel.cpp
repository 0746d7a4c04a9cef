#include "dynamics/front_kernel.h"

#include "base/kernel.h"
#include "dynamics/lanes.h"

namespace sprung {
namespace {

constexpr Index kLanes = kSpringLanes;
constexpr Index kTile = kLanes * kLanes;

/// Four columns of kVectors vectors of rows: one row of tiles where Lanes are four, two where they are eight. Such rows are worked
/// on side by side, number by number in the same order, so that results do not depend on how many they are.
template <class Lanes, int kVectors>
struct Tiles {
  static constexpr int kRows = kVectors * kCountOf<Lanes> / kLanes;
  static constexpr Index kHeight = kRows * kLanes;
  Lanes column[kLanes][kVectors];
};

[[gnu::always_inline]] inline void gather(const double* from, std::size_t, SpringLanes& to) { load_lanes(from, to); }
[[gnu::always_inline]] inline void gather(const double* from, std::size_t stride, WideLanes& to) {
  SpringLanes low;
  SpringLanes high;
  load_lanes(from, low);
  load_lanes(from + stride, high);
  to = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

[[gnu::always_inline]] inline void scatter(const SpringLanes& from, std::size_t, double* to) { store_lanes(from, to); }
[[gnu::always_inline]] inline void scatter(const WideLanes& from, std::size_t stride, double* to) {
  store_lanes(__builtin_shufflevector(from, from, 0, 1, 2, 3), to);
  store_lanes(__builtin_shufflevector(from, from, 4, 5, 6, 7), to + stride);
}

/// Where vector v begins among rows of tiles that lie `stride` numbers apart.
template <class Lanes>
[[gnu::always_inline]] inline std::size_t vector_begin(int v, std::size_t stride) {
  return static_cast<std::size_t>(v * (kCountOf<Lanes> / kLanes)) * stride;
}

/// Subtracts A B^T of `depth` columns. Those of A are one after the other, all rows that are worked on side by side.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void subtract_product(const double* a, const double* b, Index depth, Tiles<Lanes, kVectors>& from) {
  for (Index k = 0; k < depth; ++k) {
    Lanes left[kVectors];
    for (int v = 0; v < kVectors; ++v) load_lanes(a + k * from.kHeight + v * kCountOf<Lanes>, left[v]);
    for (Index c = 0; c < kLanes; ++c) {
      for (int v = 0; v < kVectors; ++v) from.column[c][v] -= left[v] * b[k * kLanes + c];
    }
  }
}

/// Rows of L D from those of the matrix, left of tile column `columns`: what the columns before have in them is taken out.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void solve_rows(const double* panel, std::size_t stride, const double* from, Index columns,
                                              double* row) {
  for (Index c = 0; c < columns; ++c) {
    const double* const diagonal = panel + c * stride;
    Tiles<Lanes, kVectors> tiles;
    for (Index q = 0; q < kLanes; ++q) {
      for (int v = 0; v < kVectors; ++v) {
        gather(from + c * kTile + q * kLanes + vector_begin<Lanes>(v, stride), stride, tiles.column[q][v]);
      }
    }
    subtract_product(row, diagonal, c * kLanes, tiles);
    for (Index q = 1; q < kLanes; ++q) {
      for (Index p = 0; p < q; ++p) {
        const double l = diagonal[c * kTile + p * kLanes + q];
        for (int v = 0; v < kVectors; ++v) tiles.column[q][v] -= tiles.column[p][v] * l;
      }
    }
    for (Index q = 0; q < kLanes; ++q) {
      for (int v = 0; v < kVectors; ++v) {
        store_lanes(tiles.column[q][v], row + (c * kLanes + q) * tiles.kHeight + v * kCountOf<Lanes>);
      }
    }
  }
}

/// Rows of L from those of L D.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void scale_rows(const double* row, std::size_t stride, const double* inverse, Index columns,
                                              double* to) {
  for (Index k = 0; k < columns * kLanes; ++k) {
    for (int v = 0; v < kVectors; ++v) {
      Lanes lanes;
      load_lanes(row + (k * kVectors + v) * kCountOf<Lanes>, lanes);
      lanes *= inverse[k];
      scatter(lanes, stride, to + k * kLanes + vector_begin<Lanes>(v, stride));
    }
  }
}

/// L D L^T of a tile on the diagonal.
[[gnu::always_inline]] inline bool eliminate_tile(Tiles<SpringLanes, 1>& tile, double* inverse) {
  bool positive = true;
  for (Index q = 0; q < kLanes; ++q) {
    SpringLanes& column = tile.column[q][0];
    positive = positive && column[q] > 0.0;
    inverse[q] = 1.0 / column[q];
    const SpringLanes scaled = column * inverse[q];
    for (Index p = q + 1; p < kLanes; ++p) tile.column[p][0] -= column * scaled[p];
    column = scaled;
    for (Index lane = 0; lane <= q; ++lane) column[lane] = 0.0;
  }
  return positive;
}

[[gnu::always_inline]] inline bool eliminate_own(const FrontShape& shape, std::size_t stride, double* panel, double* inverse,
                                                 double* row) {
  for (Index t = 0; t < shape.own_tiles; ++t) {
    double* const own = panel + t * stride;
    solve_rows<SpringLanes, 1>(panel, stride, own, t, row);
    scale_rows<SpringLanes, 1>(row, stride, inverse, t, own);
    Tiles<SpringLanes, 1> diagonal;
    for (Index q = 0; q < kLanes; ++q) load_lanes(own + t * kTile + q * kLanes, diagonal.column[q][0]);
    subtract_product(row, own, t * kLanes, diagonal);
    if (!eliminate_tile(diagonal, inverse + t * kLanes)) return false;
    for (Index q = 0; q < kLanes; ++q) store_lanes(diagonal.column[q][0], own + t * kTile + q * kLanes);
  }
  return true;
}

/// Rows of tiles below, from `t` on, as many as are left in whole Tiles, and what they hand on.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void eliminate_lower(const FrontShape& shape, std::size_t stride, Index& t, double* panel,
                                                   const double* inverse, double* update, double* row) {
  constexpr int kRows = Tiles<Lanes, kVectors>::kRows;
  double* const lower = panel + shape.own_tiles * stride;
  const auto height = static_cast<std::size_t>(shape.lower_height());
  for (; t + kRows <= shape.lower_tiles; t += kRows) {
    solve_rows<Lanes, kVectors>(panel, stride, lower + t * stride, shape.own_tiles, row);
    scale_rows<Lanes, kVectors>(row, stride, inverse, shape.own_tiles, lower + t * stride);
    for (Index s = 0; s < t + kRows; ++s) {
      Tiles<Lanes, kVectors> tiles{};
      subtract_product(row, lower + s * stride, shape.width(), tiles);
      double* const at = update + s * kLanes * height + t * kLanes;
      for (Index q = 0; q < kLanes; ++q) {
        for (int v = 0; v < kVectors; ++v) store_lanes(tiles.column[q][v], at + q * height + v * kCountOf<Lanes>);
      }
    }
  }
}

template <int kVectors>
[[gnu::always_inline]] inline bool eliminate(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  const auto stride = static_cast<std::size_t>(shape.width()) * kLanes;
  if (!eliminate_own(shape, stride, panel, inverse, row)) return false;
  Index t = 0;
  eliminate_lower<WideLanes, kVectors>(shape, stride, t, panel, inverse, update, row);
  eliminate_lower<WideLanes, 1>(shape, stride, t, panel, inverse, update, row);
  eliminate_lower<SpringLanes, 1>(shape, stride, t, panel, inverse, update, row);
  return true;
}

}  // namespace

SPRUNG_KERNEL
bool eliminate_front_narrow(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  return eliminate<1>(shape, panel, inverse, update, row);
}

SPRUNG_WIDE_KERNEL
bool eliminate_front_wide(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  return eliminate<2>(shape, panel, inverse, update, row);
}

SPRUNG_KERNEL void add_to_panel(std::span<const Index> columns, std::span<const Index> rows, const double* child,
                                Index child_height, double* panel) {
  for (std::size_t j = 0; j < 3 * columns.size(); ++j) {
    const double* const from = child + j * static_cast<std::size_t>(child_height);
    double* const to = panel + (columns[j / 3] + static_cast<Index>(j % 3)) * kLanes;
    for (std::size_t k = j; k < rows.size(); ++k) to[rows[k]] += from[k];
  }
}

SPRUNG_KERNEL void add_to_update(std::span<const RowRun> runs, const double* child, Index child_height, Index update_height,
                                 double* update) {
  const auto from_height = static_cast<std::size_t>(child_height);
  const auto to_height = static_cast<std::size_t>(update_height);
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
