// Dense elimination of one supernode (a front), in whole SIMD registers.
#pragma once

#include "base/machine/kernel.h"
#include "base/machine/simd.h"

#include <span>

namespace sprung {

/// The columns of a supernode in L D L^T, stored in 4 x 4 tiles: four rows of a column side by side, then those of the next
/// column. The supernode's own rows come first; their entries on and above the diagonal are unused. The rows below follow. Rows
/// and columns of the identity pad both to whole tiles.
struct FrontShape {
  Index own_tiles = 0;    ///< tiles along the supernode's own rows and columns
  Index lower_tiles = 0;  ///< tiles along the rows below

  [[nodiscard]] Index width() const { return own_tiles * kSimdWidth; }
  [[nodiscard]] Index lower_height() const { return lower_tiles * kSimdWidth; }
  /// Index of an entry in the panel.
  [[nodiscard]] std::size_t index(Index row, Index column) const {
    return (static_cast<std::size_t>(row / kSimdWidth) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(column)) *
               kSimdWidth +
           static_cast<std::size_t>(row % kSimdWidth);
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(own_tiles + lower_tiles) * kSimdWidth * static_cast<std::size_t>(width());
  }
};

/// Numbers of scratch that `eliminate_front` needs in `row` for each column of a front.
inline constexpr Index kRowRoom = 8 * kSimdWidth;

/// Replaces the panel of the matrix by that of L and writes 1 / D to `inverse`. Writes the update that the rows below pass to the
/// parent, -L D L^T, to `update`: column by column, `lower_height` numbers each; entries above the diagonal are unused. Returns
/// whether D is positive; if not, all outputs are undefined.
bool eliminate_front_narrow(const FrontShape& shape, double* panel, double* inverse, double* update, double* row);
bool eliminate_front_narrow(const FrontShape& shape, float* panel, float* inverse, float* update, float* row);

/// The same bits with wider registers. Requires has_wide_lanes().
bool eliminate_front_wide(const FrontShape& shape, double* panel, double* inverse, double* update, double* row);
bool eliminate_front_wide(const FrontShape& shape, float* panel, float* inverse, float* update, float* row);

/// Chooses the version for this machine.
template <class Number>
bool eliminate_front(const FrontShape& shape, Number* panel, Number* inverse, Number* update, Number* row) {
  return has_wide_lanes() ? eliminate_front_wide(shape, panel, inverse, update, row)
                          : eliminate_front_narrow(shape, panel, inverse, update, row);
}

/// Rows that are neighbours both in a front's update and in its parent's.
struct RowRun {
  Index from;
  Index to;
  Index length;
};

/// Where the rows of a front's update begin in its parent's panel, ascending.
struct PanelRows {
  struct Row {
    Index from;
    Index to;
  };
  std::span<const Row> whole;   ///< the first of four neighbouring rows that fill a row of tiles
  std::span<const Row> single;  ///< all other rows
};

/// Adds a child's update to its parent's own columns, before the parent is eliminated. `columns` are the first rows below of the
/// child, the first of three each; `rows` are all its rows. The two arrays share no memory.
void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const double* child, Index child_height, double* panel);
void add_to_panel(std::span<const Index> columns, const PanelRows& rows, const float* child, Index child_height, float* panel);

/// Adds the rest of the child's update to the parent's update, after the parent was eliminated. The two arrays share no memory.
void add_to_update(std::span<const RowRun> runs, const double* child, Index child_height, Index update_height, double* update);
void add_to_update(std::span<const RowRun> runs, const float* child, Index child_height, Index update_height, float* update);

/// Solves L x = b for the supernode's own rows in place, and writes to `below` what to subtract from the rows below.
void solve_front(const FrontShape& shape, const double* panel, double* own, double* below);
void solve_front(const FrontShape& shape, const float* panel, float* own, float* below);

/// Solves D L^T x = b for the supernode's own rows in place. Requires that the rows below are solved.
void solve_front_transposed(const FrontShape& shape, const double* panel, const double* inverse, double* own, const double* below,
                            double* sums);
void solve_front_transposed(const FrontShape& shape, const float* panel, const float* inverse, float* own, const float* below,
                            float* sums);

}  // namespace sprung
