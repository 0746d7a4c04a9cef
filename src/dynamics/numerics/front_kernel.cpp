#include "dynamics/numerics/front_kernel.h"

#include "base/machine/kernel.h"
#include "dynamics/numerics/front_tiles.h"

namespace sprung {
namespace {

/// Computes rows of L D left of tile column `columns`: subtracts the contribution of the columns before.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void solve_rows(const NumberOf<Lanes>* panel, std::size_t stride, const NumberOf<Lanes>* from,
                                              Index columns, NumberOf<Lanes>* row) {
  for (Index c = 0; c < columns; ++c) {
    const NumberOf<Lanes>* const diagonal = panel + c * stride;
    Tiles<Lanes, kVectors> tiles;
    gather_tiles(from + c * kTile, stride, tiles);
    subtract_product(row, diagonal, c * kSimdWidth, tiles);
    for (Index q = 1; q < kSimdWidth; ++q) {
      for (Index p = 0; p < q; ++p) {
        const NumberOf<Lanes> l = diagonal[c * kTile + p * kSimdWidth + q];
        for (int v = 0; v < kVectors; ++v) tiles.column[q][v] -= tiles.column[p][v] * l;
      }
    }
    for (Index q = 0; q < kSimdWidth; ++q) {
      for (int v = 0; v < kVectors; ++v) {
        store_simd(tiles.column[q][v], row + (c * kSimdWidth + q) * tiles.kHeight + v * kCountOf<Lanes>);
      }
    }
  }
}

/// Computes rows of L from rows of L D.
template <class Lanes, int kVectors>
[[gnu::always_inline]] inline void scale_rows(const NumberOf<Lanes>* row, std::size_t stride, const NumberOf<Lanes>* inverse,
                                              Index columns, NumberOf<Lanes>* to) {
  for (Index k = 0; k < columns * kSimdWidth; ++k) {
    for (int v = 0; v < kVectors; ++v) {
      Lanes lanes;
      load_simd(row + (k * kVectors + v) * kCountOf<Lanes>, lanes);
      lanes *= inverse[k];
      scatter(lanes, stride, to + k * kSimdWidth + vector_begin<Lanes>(v, stride));
    }
  }
}

/// Factors a diagonal tile into L D L^T.
template <class Lanes>
[[gnu::always_inline]] inline bool eliminate_tile(Tiles<Lanes, 1>& tile, NumberOf<Lanes>* inverse) {
  bool positive = true;
  for (Index q = 0; q < kSimdWidth; ++q) {
    Lanes& column = tile.column[q][0];
    positive = positive && column[q] > 0;
    inverse[q] = 1 / column[q];
    const Lanes scaled = column * inverse[q];
    for (Index p = q + 1; p < kSimdWidth; ++p) tile.column[p][0] -= column * scaled[p];
    column = scaled;
    for (Index lane = 0; lane <= q; ++lane) column[lane] = 0;
  }
  return positive;
}

/// Eliminates some tiles of a supernode's own rows after the columns before were subtracted.
template <class Number>
[[gnu::always_inline]] inline bool eliminate_corner(Index tiles, std::size_t stride, Number* panel, Number* inverse, Number* row) {
  using Lanes = typename SimdOf<Number, kSimdWidth>::Type;
  for (Index t = 0; t < tiles; ++t) {
    Number* const own = panel + t * stride;
    solve_rows<Lanes, 1>(panel, stride, own, t, row);
    scale_rows<Lanes, 1>(row, stride, inverse, t, own);
    Tiles<Lanes, 1> diagonal;
    gather_tiles(own + t * kTile, stride, diagonal);
    subtract_product(row, own, t * kSimdWidth, diagonal);
    if (!eliminate_tile(diagonal, inverse + t * kSimdWidth)) return false;
    scatter_tiles(diagonal, stride, own + t * kTile);
  }
  return true;
}

/// Eliminates the supernode's own rows of tiles from `t` on, as many as fill whole `Tiles`.
template <class Lanes, int kVectors, class Number>
[[gnu::always_inline]] inline bool eliminate_own(const FrontShape& shape, std::size_t stride, Index& t, Number* panel,
                                                 Number* inverse, Number* row) {
  constexpr Index kRows = Tiles<Lanes, kVectors>::kRows;
  for (; t + kRows <= shape.own_tiles; t += kRows) {
    Number* const own = panel + t * stride;
    solve_rows<Lanes, kVectors>(panel, stride, own, t, row);
    scale_rows<Lanes, kVectors>(row, stride, inverse, t, own);
    for (Index s = t; s < t + kRows; ++s) {
      Tiles<Lanes, kVectors> tiles;
      gather_tiles(own + s * kTile, stride, tiles);
      subtract_product(row, panel + s * stride, t * kSimdWidth, tiles);
      scatter_tiles(tiles, stride, own + s * kTile);
    }
    if (!eliminate_corner(kRows, stride, own + t * kTile, inverse + t * kSimdWidth, row)) return false;
  }
  return true;
}

/// Eliminates the rows of tiles below from `t` on, as many as fill whole `Tiles`, and computes their update.
template <class Lanes, int kVectors, class Number>
[[gnu::always_inline]] inline void eliminate_lower(const FrontShape& shape, std::size_t stride, Index& t, Number* panel,
                                                   const Number* inverse, Number* update, Number* row) {
  constexpr Index kRows = Tiles<Lanes, kVectors>::kRows;
  Number* const lower = panel + shape.own_tiles * stride;
  const auto height = static_cast<std::size_t>(shape.lower_height());
  for (; t + kRows <= shape.lower_tiles; t += kRows) {
    solve_rows<Lanes, kVectors>(panel, stride, lower + t * stride, shape.own_tiles, row);
    scale_rows<Lanes, kVectors>(row, stride, inverse, shape.own_tiles, lower + t * stride);
    for (Index s = 0; s < t + kRows; ++s) {
      Tiles<Lanes, kVectors> tiles{};
      subtract_product(row, lower + s * stride, shape.width(), tiles);
      Number* const at = update + s * kSimdWidth * height + t * kSimdWidth;
      for (Index q = 0; q < kSimdWidth; ++q) {
        for (int v = 0; v < kVectors; ++v) store_simd(tiles.column[q][v], at + q * height + v * kCountOf<Lanes>);
      }
    }
  }
}

/// Uses registers of kCount lanes, then half as many for the rows that are left.
template <Index kCount, int kVectors, class Number>
[[gnu::always_inline]] inline bool eliminate_own_rows(const FrontShape& shape, std::size_t stride, Index t, Number* panel,
                                                      Number* inverse, Number* row) {
  using Lanes = typename SimdOf<Number, kCount>::Type;
  if (!eliminate_own<Lanes, kVectors>(shape, stride, t, panel, inverse, row)) return false;
  if constexpr (kVectors > 1) {
    return eliminate_own_rows<kCount, kVectors / 2>(shape, stride, t, panel, inverse, row);
  } else if constexpr (kCount > kSimdWidth) {
    return eliminate_own_rows<kCount / 2, 1>(shape, stride, t, panel, inverse, row);
  }
  return true;
}

template <Index kCount, int kVectors, class Number>
[[gnu::always_inline]] inline void eliminate_lower_rows(const FrontShape& shape, std::size_t stride, Index t, Number* panel,
                                                        const Number* inverse, Number* update, Number* row) {
  using Lanes = typename SimdOf<Number, kCount>::Type;
  eliminate_lower<Lanes, kVectors>(shape, stride, t, panel, inverse, update, row);
  if constexpr (kVectors > 1) {
    eliminate_lower_rows<kCount, kVectors / 2>(shape, stride, t, panel, inverse, update, row);
  } else if constexpr (kCount > kSimdWidth) {
    eliminate_lower_rows<kCount / 2, 1>(shape, stride, t, panel, inverse, update, row);
  }
}

template <std::size_t kBytes, int kVectors, class Number>
[[gnu::always_inline]] inline bool eliminate(const FrontShape& shape, Number* panel, Number* inverse, Number* update, Number* row) {
  constexpr auto kCount = static_cast<Index>(kBytes / sizeof(Number));
  const auto stride = static_cast<std::size_t>(shape.width()) * kSimdWidth;
  if (!eliminate_own_rows<kCount, kVectors>(shape, stride, 0, panel, inverse, row)) return false;
  eliminate_lower_rows<kCount, kVectors>(shape, stride, 0, panel, inverse, update, row);
  return true;
}

template <class Lanes>
[[gnu::always_inline]] inline void add_lanes(const NumberOf<Lanes>* from, NumberOf<Lanes>* to) {
  Lanes added;
  Lanes sum;
  load_simd(from, added);
  load_simd(to, sum);
  sum += added;
  store_simd(sum, to);
}

template <class Number>
[[gnu::always_inline]] inline void add_numbers(const Number* from, Index count, Number* to) {
  Index k = 0;
  for (; k + 2 * kSimdWidth <= count; k += 2 * kSimdWidth)
    add_lanes<typename SimdOf<Number, 2 * kSimdWidth>::Type>(from + k, to + k);
  for (; k + kSimdWidth <= count; k += kSimdWidth) add_lanes<typename SimdOf<Number, kSimdWidth>::Type>(from + k, to + k);
  for (; k < count; ++k) to[k] += from[k];
}

// Adds rows above the diagonal of a shared tile too: their entries are unused before and after.
template <class Number>
[[gnu::always_inline]] inline void add_panel(std::span<const Index> columns, const PanelRows& rows, const Number* child,
                                             Index child_height, Number* panel) {
  using Lanes = typename SimdOf<Number, kSimdWidth>::Type;
  auto whole = rows.whole.begin();
  auto single = rows.single.begin();
  for (Index j = 0; j < 3 * static_cast<Index>(columns.size()); ++j) {
    const Number* const from = child + static_cast<std::size_t>(j) * static_cast<std::size_t>(child_height);
    Number* const to = panel + (columns[static_cast<std::size_t>(j) / 3] + j % 3) * kSimdWidth;
    while (whole != rows.whole.end() && whole->from + kSimdWidth <= j) ++whole;
    while (single != rows.single.end() && single->from < j) ++single;
    for (auto row = whole; row != rows.whole.end(); ++row) add_lanes<Lanes>(from + row->from, to + row->to);
    for (auto row = single; row != rows.single.end(); ++row) to[row->to] += from[row->from];
  }
}

template <class Number>
[[gnu::always_inline]] inline void add_update(std::span<const RowRun> runs, const Number* child, Index child_height,
                                              Index update_height, Number* update) {
  const auto from_height = static_cast<std::size_t>(child_height);
  const auto to_height = static_cast<std::size_t>(update_height);
  for (std::size_t first = 0; first < runs.size(); ++first) {
    for (Index q = 0; q < runs[first].length; ++q) {
      const Number* const from = child + static_cast<std::size_t>(runs[first].from + q) * from_height;
      Number* const to = update + static_cast<std::size_t>(runs[first].to + q) * to_height;
      add_numbers(from + runs[first].from + q, runs[first].length - q, to + runs[first].to + q);
      for (const RowRun& run : runs.subspan(first + 1)) add_numbers(from + run.from, run.length, to + run.to);
    }
  }
}

}  // namespace

SPRUNG_KERNEL bool eliminate_front_narrow(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  return eliminate<sizeof(Double4), 2>(shape, panel, inverse, update, row);
}
SPRUNG_KERNEL bool eliminate_front_narrow(const FrontShape& shape, float* panel, float* inverse, float* update, float* row) {
  return eliminate<sizeof(Double4), 2>(shape, panel, inverse, update, row);
}

SPRUNG_WIDE_KERNEL bool eliminate_front_wide(const FrontShape& shape, double* panel, double* inverse, double* update, double* row) {
  return eliminate<sizeof(Double8), 2>(shape, panel, inverse, update, row);
}
SPRUNG_WIDE_KERNEL bool eliminate_front_wide(const FrontShape& shape, float* panel, float* inverse, float* update, float* row) {
  return eliminate<sizeof(Double8), 2>(shape, panel, inverse, update, row);
}

SPRUNG_KERNEL void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const double* child, Index child_height,
                                double* panel) {
  add_panel(columns, rows, child, child_height, panel);
}
SPRUNG_KERNEL void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const float* child, Index child_height,
                                float* panel) {
  add_panel(columns, rows, child, child_height, panel);
}

SPRUNG_KERNEL void add_to_update(std::span<const RowRun> runs, const double* child, Index child_height, Index update_height,
                                 double* update) {
  add_update(runs, child, child_height, update_height, update);
}
SPRUNG_KERNEL void add_to_update(std::span<const RowRun> runs, const float* child, Index child_height, Index update_height,
                                 float* update) {
  add_update(runs, child, child_height, update_height, update);
}

}  // namespace sprung
