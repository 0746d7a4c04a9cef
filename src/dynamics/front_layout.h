// Where the numbers of a sparse factor are kept, and which go where: all that can be known before the numbers.
#pragma once

#include "dynamics/block_matrix.h"
#include "dynamics/front_kernel.h"

#include <vector>

namespace sprung {

/// The supernodes of a matrix of 3 x 3 blocks as fronts: dense panels of their own columns, and what they hand on to their parents
/// (Duff and Reid 1983). Each front's own part of a vector is filled up to whole registers; a particle's place is where its three
/// numbers begin in such a vector. Places ascend in the order of elimination.
struct FrontLayout {
  struct Front {
    FrontShape shape;
    Index parent = kNone;
    Index first_place = 0;              ///< of its own part of a vector
    std::vector<Index> own;             ///< its particles
    std::vector<Index> lower;           ///< the places of those below
    std::vector<Index> parent_columns;  ///< of those that are the parent's own, the first ones
    PanelRows parent_rows;              ///< three of each below
    std::vector<RowRun> runs;           ///< of those that are below in the parent too, counted from there
    std::vector<Index> children;
    std::size_t panel = 0;   ///< where it begins among all panels
    std::size_t update = 0;  ///< where what it hands on begins
    std::size_t end_entry = 0;

    /// Row of a place, its own or one of those below.
    [[nodiscard]] Index row_of(Index place) const;
  };
  /// A block of the matrix, on the diagonal or as BlockMatrix counts those beside it, and where it is added.
  struct Entry {
    Index block;
    Index row;
    Index column;
    bool on_diagonal;
    bool transposed;
  };

  /// Rows and columns of which `left_out` has the flag are no part of it; none has when it is empty.
  FrontLayout(const BlockMatrix& pattern, const std::vector<bool>& left_out);

  std::vector<Front> fronts;   ///< children before their parents
  std::vector<Entry> entries;  ///< of one front after the other
  std::vector<Index> place;    ///< of particles, or kNone
  std::size_t vector_size = 0;
  std::size_t panel_size = 0;
  std::size_t update_size = 0;

 private:
  void place_fronts(const BlockMatrix& pattern, const std::vector<bool>& left_out);
  void join_with_parents();
  void place_updates();
  void place_entries(const BlockMatrix& pattern);
};

}  // namespace sprung
