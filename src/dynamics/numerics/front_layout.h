// The memory layout of a sparse factor: everything that depends on the pattern alone.
#pragma once

#include "dynamics/numerics/block_matrix.h"
#include "dynamics/numerics/front_kernel.h"

#include <span>
#include <vector>

namespace sprung {

struct Supernode;

/// The supernodes of a matrix of 3 x 3 blocks as fronts: dense panels of their own columns and the updates that they pass to their
/// parents (Duff and Reid 1983). Each front's slice of a vector is padded to whole registers; a particle's slot is where its three
/// numbers begin in such a vector. Slots ascend in the order of elimination.
/// A factor may exceed the caches. Panels, updates and index lists are therefore stored in the order in which each pass reads
/// them.
struct FrontLayout {
  /// A range of one of the arrays below.
  struct Range {
    Index begin = 0;
    Index end = 0;
  };
  struct Front {
    FrontShape shape;
    Index own_rows = 0;      ///< without padding
    Index first_slot = 0;    ///< of its slice of a vector
    Range lower;             ///< of `lower`: the slots of the rows below
    Range children;          ///< of `children`
    std::size_t panel = 0;   ///< where it begins in the array of panels
    std::size_t update = 0;  ///< where its update begins
    std::size_t end_entry = 0;
  };
  /// A front's update and where its parent adds it.
  struct Child {
    Index height = 0;        ///< of the update
    std::size_t update = 0;  ///< where it begins
    Range columns;           ///< of `columns`: the first rows below, which are columns of the parent
    Range whole;             ///< of `whole`, and
    Range single;            ///< of `single`: three for each row below
    Range runs;              ///< of `runs`: rows that are below the parent too, counted from there
  };
  /// A block of the matrix, on the diagonal or numbered as BlockMatrix does, and where it is added.
  struct Entry {
    Index block;
    Index row;
    Index column;
    bool on_diagonal;
    bool transposed;
  };

  /// Rows and columns flagged in `left_out` are excluded; an empty vector excludes none.
  FrontLayout(const BlockMatrix& pattern, const std::vector<bool>& left_out);

  [[nodiscard]] std::span<const Index> lower_of(const Front& front) const { return slice(lower, front.lower); }
  [[nodiscard]] std::span<const Child> children_of(const Front& front) const { return slice(children, front.children); }
  [[nodiscard]] std::span<const Index> columns_of(const Child& child) const { return slice(columns, child.columns); }
  [[nodiscard]] PanelRows rows_of(const Child& child) const { return {slice(whole, child.whole), slice(single, child.single)}; }
  [[nodiscard]] std::span<const RowRun> runs_of(const Child& child) const { return slice(runs, child.runs); }

  std::vector<Front> fronts;  ///< children before their parents
  std::vector<Index> lower;   ///< one front after the other, as all arrays up to `entries`
  std::vector<Child> children;
  std::vector<Index> columns;
  std::vector<PanelRows::Row> whole;
  std::vector<PanelRows::Row> single;
  std::vector<RowRun> runs;
  std::vector<Entry> entries;
  std::vector<Index> slot;  ///< slot of each particle, or kNone
  std::size_t vector_size = 0;
  std::size_t panel_size = 0;
  std::size_t update_size = 0;

 private:
  template <class T>
  [[nodiscard]] static std::span<const T> slice(const std::vector<T>& of, Range range) {
    return std::span(of).subspan(range.begin, range.end - range.begin);
  }
  /// Row of a slot in a front: one of its own rows or of the rows below.
  [[nodiscard]] Index row_of(const Front& front, Index at) const;

  void make_fronts(const std::vector<Supernode>& nodes);
  void position_updates(const std::vector<Supernode>& nodes);
  void join_with_parents(const std::vector<Supernode>& nodes);
  void add_child(const Front& parent, const Front& child);
  void add_rows(const FrontShape& parent, const std::vector<Index>& rows);
  void make_entries(const BlockMatrix& pattern, const std::vector<Supernode>& nodes);
};

}  // namespace sprung
