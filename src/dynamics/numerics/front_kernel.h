// Elimination of a supernode: dense work of whole registers.
#pragma once

#include "base/kernel.h"
#include "base/simd.h"

#include <span>

namespace sprung {

/// The columns of a supernode in L D L^T, in tiles: rows four at a time, the four numbers of a column side by side, then those of
/// the next column. First the rows of the supernode itself, as many as its columns, of which those on and above the diagonal are
/// not meant; then the rows below. Both are filled up to whole tiles by rows and columns of the identity.
struct FrontShape {
  Index own_tiles = 0;    ///< of rows and columns
  Index lower_tiles = 0;  ///< of rows below

  [[nodiscard]] Index width() const { return own_tiles * kSimdWidth; }
  [[nodiscard]] Index lower_height() const { return lower_tiles * kSimdWidth; }
  /// Where a number is in the panel.
  [[nodiscard]] std::size_t place(Index row, Index column) const {
    return (static_cast<std::size_t>(row / kSimdWidth) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(column)) *
               kSimdWidth +
           static_cast<std::size_t>(row % kSimdWidth);
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(own_tiles + lower_tiles) * kSimdWidth * static_cast<std::size_t>(width());
  }
};

/// How many numbers of `row` eliminate_front needs for each of a front's columns.
inline constexpr Index kRowRoom = 8 * kSimdWidth;

/// Replaces the panel of a matrix by that of its L, writes 1 / D to `inverse`, and what the rows below hand on, - L D L^T, to
/// `update`, column by column, `lower_height` numbers each, of which those above the diagonal are not meant. Returns whether D is
/// positive; if not, what is written is not meant.
bool eliminate_front_narrow(const FrontShape& shape, double* panel, double* inverse, double* update, double* row);
bool eliminate_front_narrow(const FrontShape& shape, float* panel, float* inverse, float* update, float* row);

/// The same bits, with more lanes at a time. Requires has_wide_lanes().
bool eliminate_front_wide(const FrontShape& shape, double* panel, double* inverse, double* update, double* row);
bool eliminate_front_wide(const FrontShape& shape, float* panel, float* inverse, float* update, float* row);

/// Whichever the machine has.
template <class Number>
bool eliminate_front(const FrontShape& shape, Number* panel, Number* inverse, Number* update, Number* row) {
  return has_wide_lanes() ? eliminate_front_wide(shape, panel, inverse, update, row)
                          : eliminate_front_narrow(shape, panel, inverse, update, row);
}

/// Rows that are neighbours in what a front hands on, and in its parent's.
struct RowRun {
  Index from;
  Index to;
  Index length;
};

/// Where the rows that a front hands on begin in its parent's panel, in ascending order.
struct PanelRows {
  struct Place {
    Index from;
    Index to;
  };
  std::span<const Place> whole;   ///< the first of four neighbours that fill a row of tiles
  std::span<const Place> single;  ///< all others
};

/// Adds what a child hands on to its parent's own columns, before the parent is eliminated. `columns` are those of the child's
/// first rows below, each the first of three; `rows` are those of all its rows. The two share no memory.
void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const double* child, Index child_height, double* panel);
void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const float* child, Index child_height, float* panel);

/// Adds the rest to what the parent hands on, when it has been eliminated. The two share no memory.
void add_to_update(std::span<const RowRun> runs, const double* child, Index child_height, Index update_height, double* update);
void add_to_update(std::span<const RowRun> runs, const float* child, Index child_height, Index update_height, float* update);

/// Solves L x = b for the supernode's own part, in place, and writes what is to be subtracted from the rows below.
void solve_front(const FrontShape& shape, const double* panel, double* own, double* below);
void solve_front(const FrontShape& shape, const float* panel, float* own, float* below);

/// Solves D L^T x = b for the supernode's own part, in place, when the rows below are solved.
void solve_front_transposed(const FrontShape& shape, const double* panel, const double* inverse, double* own, const double* below,
                            double* sums);
void solve_front_transposed(const FrontShape& shape, const float* panel, const float* inverse, float* own, const float* below,
                            float* sums);

}  // namespace sprung
