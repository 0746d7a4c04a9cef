// Symmetric matrices that couple particles: how forces change with positions and velocities.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// Two particles that share a block beside the diagonal, in either order.
struct ParticlePair {
  Index first = kNone;
  Index second = kNone;
};

/// A sparse symmetric matrix of 3 x 3 blocks, a row and a column of them a particle. Blocks on the diagonal and below it are kept,
/// by columns; those above are their mirrors.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// All zero. Each particle has a block on the diagonal, each pair one beside it, however often it is named.
  BlockMatrix(Index particles, std::vector<ParticlePair> pairs);

  void set_zero();

  /// Adds to the block in row `row` and column `column`, and the transpose to its mirror. On the diagonal the block must be
  /// symmetric; beside it the pair must be one of the matrix's.
  void add(Index row, Index column, const Matrix3& block);

  /// Adds what a force along the difference of two particles gives: `block` to their two diagonal blocks, -`block` beside them.
  void add_difference(Index a, Index b, const Matrix3& block);

  /// Adds `factor` times another matrix that was made of the same pairs.
  void add_scaled(const BlockMatrix& other, double factor);

  /// Adds `factor` times this times `vectors`, 3 x n, to `result`.
  void add_product(const Points& vectors, double factor, Points& result) const;

  [[nodiscard]] Index size() const { return static_cast<Index>(diagonal_.size()); }
  [[nodiscard]] const Matrix3& diagonal(Index i) const { return diagonal_[static_cast<std::size_t>(i)]; }
  /// Blocks below the diagonal, counted column by column, rows ascending.
  [[nodiscard]] const Matrix3& beside(Index block) const { return blocks_[static_cast<std::size_t>(block)]; }

  /// Calls `visit(row, block)` for the blocks of a column below the diagonal, rows ascending.
  template <class Visit>
  void for_column(Index column, Visit&& visit) const {
    const auto j = static_cast<std::size_t>(column);
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k) visit(rows_[k], blocks_[k]);
  }

 private:
  std::vector<Matrix3> diagonal_;
  std::vector<std::size_t> begin_;  // of each column in rows_ and blocks_
  std::vector<Index> rows_;
  std::vector<Matrix3> blocks_;
};

}  // namespace sprung
