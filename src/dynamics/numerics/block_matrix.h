// Sparse symmetric matrices of 3 x 3 blocks that couple particles, such as the derivatives of forces.
#pragma once

#include "base/types.h"

#include <compare>
#include <vector>

namespace sprung {

/// Two particles that share an off-diagonal block, in either order.
struct ParticlePair {
  Index first = kNone;
  Index second = kNone;

  [[nodiscard]] auto operator<=>(const ParticlePair&) const = default;
};

/// A sparse symmetric matrix of 3 x 3 blocks, one block row and column per particle. Stores the blocks on and below the diagonal
/// by columns; the blocks above are their transposes.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// A zero matrix. Each particle has a diagonal block, each pair an off-diagonal block; a pair may be named several times.
  BlockMatrix(Index particles, std::vector<ParticlePair> pairs);

  void set_zero();

  /// Adds to the block in row `row` and column `column`, and its transpose to the mirrored block. A diagonal block must stay
  /// symmetric. An off-diagonal pair must be one of the constructor's.
  void add(Index row, Index column, const Matrix3& block);

  /// Adds the derivative of a force that depends on the difference of two particles: `block` to both diagonal blocks, -`block` to
  /// the off-diagonal ones.
  void add_difference(Index a, Index b, const Matrix3& block);

  /// Adds `factor` times another matrix made of the same pairs.
  void add_scaled(const BlockMatrix& other, double factor);

  /// Adds `factor` times this matrix times `vectors`, 3 x n, to `result`.
  void add_product(const Points& vectors, double factor, Points& result) const;

  [[nodiscard]] Index size() const { return static_cast<Index>(diagonal_.size()); }
  [[nodiscard]] const Matrix3& diagonal(Index i) const { return diagonal_[static_cast<std::size_t>(i)]; }
  /// The blocks below the diagonal, counted column by column with ascending rows.
  [[nodiscard]] const Matrix3& beside(Index block) const { return blocks_[static_cast<std::size_t>(block)]; }

  /// Calls `visit(row, block)` for each block of a column below the diagonal, rows ascending.
  template <class Visit>
  void for_column(Index column, Visit&& visit) const {
    const auto j = static_cast<std::size_t>(column);
    for (std::size_t k = begin_[j]; k < begin_[j + 1]; ++k) visit(rows_[k], blocks_[k]);
  }

 private:
  std::vector<Matrix3> diagonal_;
  std::vector<std::size_t> begin_;  // start of each column in rows_ and blocks_
  std::vector<Index> rows_;
  std::vector<Matrix3> blocks_;
};

}  // namespace sprung
