// Disjoint sets of indices.
#pragma once

#include "base/types.h"

#include <numeric>
#include <vector>

namespace sprung {

/// Each index is alone in its set at first. Paths are halved, so that a query takes nearly constant time (Tarjan and van Leeuwen
/// 1984).
class UnionFind {
 public:
  explicit UnionFind(Index count) : parent_(static_cast<std::size_t>(count)) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The index that represents the set of `i`.
  [[nodiscard]] Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(Index a, Index b) { parent_[root(a)] = root(b); }

 private:
  std::vector<Index> parent_;
};

}  // namespace sprung
