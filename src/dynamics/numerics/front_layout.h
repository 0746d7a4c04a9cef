// Where the numbers of a sparse factor are kept, and which go where: all that can be known before the numbers.
#pragma once

#include "dynamics/numerics/block_matrix.h"
#include "dynamics/numerics/front_kernel.h"

#include <span>
#include <vector>

namespace sprung {

struct Supernode;

/// The supernodes of a matrix of 3 x 3 blocks as fronts: dense panels of their own columns, and what they hand on to their parents
/// (Duff and Reid 1983). Each front's own part of a vector is filled up to whole registers; a particle's place is where its three
/// numbers begin in such a vector. Places ascend in the order of elimination. A factor may be larger than the caches, and each pass
/// over it drives all else out of them: what passes read lies in the order in which they read it.
struct FrontLayout {
  /// A part of one of the arrays below.
  struct Range {
    Index begin = 0;
    Index end = 0;
  };
  struct Front {
    FrontShape shape;
    Index own_rows = 0;      ///< without those that fill up
    Index first_place = 0;   ///< of its own part of a vector
    Range lower;             ///< of `lower`: the places of those below
    Range children;          ///< of `children`
    std::size_t panel = 0;   ///< where it begins among all panels
    std::size_t update = 0;  ///< where what it hands on begins
    std::size_t end_entry = 0;
  };
  /// What a front hands on to its parent, and where that adds it.
  struct Child {
    Index height = 0;        ///< of what is handed on
    std::size_t update = 0;  ///< where it begins
    Range columns;           ///< of `columns`: of those below that are the parent's own, the first ones
    Range whole;             ///< of `whole`, and
    Range single;            ///< of `single`: three of each below
    Range runs;              ///< of `runs`: of those that are below in the parent too, counted from there
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

  [[nodiscard]] std::span<const Index> lower_of(const Front& front) const { return part(lower, front.lower); }
  [[nodiscard]] std::span<const Child> children_of(const Front& front) const { return part(children, front.children); }
  [[nodiscard]] std::span<const Index> columns_of(const Child& child) const { return part(columns, child.columns); }
  [[nodiscard]] PanelRows rows_of(const Child& child) const { return {part(whole, child.whole), part(single, child.single)}; }
  [[nodiscard]] std::span<const RowRun> runs_of(const Child& child) const { return part(runs, child.runs); }

  std::vector<Front> fronts;  ///< children before their parents
  std::vector<Index> lower;   ///< of one front after the other, as what follows up to `entries`
  std::vector<Child> children;
  std::vector<Index> columns;
  std::vector<PanelRows::Place> whole;
  std::vector<PanelRows::Place> single;
  std::vector<RowRun> runs;
  std::vector<Entry> entries;
  std::vector<Index> place;  ///< of particles, or kNone
  std::size_t vector_size = 0;
  std::size_t panel_size = 0;
  std::size_t update_size = 0;

 private:
  template <class T>
  [[nodiscard]] static std::span<const T> part(const std::vector<T>& of, Range range) {
    return std::span(of).subspan(range.begin, range.end - range.begin);
  }
  /// Row of a place, its own or one of those below.
  [[nodiscard]] Index row_of(const Front& front, Index at) const;

  void place_fronts(const std::vector<Supernode>& nodes);
  void place_updates(const std::vector<Supernode>& nodes);
  void join_with_parents(const std::vector<Supernode>& nodes);
  void add_child(const Front& parent, const Front& child);
  void add_rows(const FrontShape& parent, const std::vector<Index>& rows);
  void place_entries(const BlockMatrix& pattern, const std::vector<Supernode>& nodes);
};

}  // namespace sprung
