// The elimination order of a sparse symmetric matrix, and the rows that are eliminated together.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// The off-diagonal pattern of a symmetric matrix: row i shares entries with others[begin[i]] ... others[begin[i + 1] - 1].
struct MatrixGraph {
  std::vector<Index> begin{0};
  std::vector<Index> others;

  [[nodiscard]] Index size() const { return static_cast<Index>(begin.size()) - 1; }
};

/// Rows that are eliminated together as one dense block of the factor.
struct Supernode {
  std::vector<Index> columns;  ///< eliminated rows, in this order
  std::vector<Index> rows;     ///< rows that they are coupled to afterwards, in the order of their own elimination
  Index parent = kNone;        ///< the supernode that eliminates the first of `rows`; kNone without rows
};

/// Supernodes in the order of elimination, children before parents. The order is minimum degree (Amestoy, Davis and Duff 1996).
/// Supernodes are merged where dense work on zeros costs less than it saves (relaxed supernodes, Ashcraft and Grimes 1989).
[[nodiscard]] std::vector<Supernode> find_supernodes(const MatrixGraph& graph);

}  // namespace sprung
