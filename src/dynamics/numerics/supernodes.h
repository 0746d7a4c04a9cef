// In which order a sparse symmetric matrix is eliminated, and which of its rows together.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// Which rows of a symmetric matrix share entries beside the diagonal: those of row i are [begin[i], begin[i + 1]) of `others`.
struct MatrixGraph {
  std::vector<Index> begin{0};
  std::vector<Index> others;

  [[nodiscard]] Index size() const { return static_cast<Index>(begin.size()) - 1; }
};

/// Rows that are eliminated together, as one dense block of the factor.
struct Supernode {
  std::vector<Index> columns;  ///< what is eliminated, in this order
  std::vector<Index> rows;     ///< what it is coupled to then, in the order of their own elimination
  Index parent = kNone;        ///< the supernode that the first of `rows` is eliminated in; none without rows
};

/// Supernodes in the order of elimination, each after those whose parent it is: minimum degree (Amestoy, Davis and Duff 1996), then
/// joined where dense work on what is zero costs less than it saves (relaxed supernodes, Ashcraft and Grimes 1989).
[[nodiscard]] std::vector<Supernode> find_supernodes(const MatrixGraph& graph);

}  // namespace sprung
