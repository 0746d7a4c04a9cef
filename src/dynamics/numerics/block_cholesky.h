// A direct solver for sparse symmetric matrices of 3 x 3 blocks.
#pragma once

#include "base/files/binary_archive.h"
#include "base/machine/huge_pages.h"
#include "dynamics/numerics/block_matrix.h"
#include "dynamics/numerics/front_layout.h"

#include <vector>

namespace sprung {

/// L D L^T of a positive definite matrix, in double or single precision (`Number`). Supernodes are eliminated as dense blocks
/// (multifrontal: Duff and Reid 1983). The constructor finds the order and the pattern once. Runs on one thread. Scaling the
/// matrix or a vector by a power of two scales the result and changes no other bit.
template <class Number>
class BlockCholesky {
 public:
  /// For matrices with the pairs of `pattern`. Rows and columns of particles flagged in `left_out` are excluded; an empty vector
  /// excludes none.
  explicit BlockCholesky(const BlockMatrix& pattern, const std::vector<bool>& left_out = {});

  /// Factors A, the matrix with its diagonal multiplied by 1 + `raise`, and solves A x = `right`; both are 3 x particles.
  /// `solution` may be `right` itself. Excluded particles get zero. Returns false where rounding no longer shows that the factored
  /// matrix is positive definite; `solution` is unchanged then.
  [[nodiscard]] bool factor_and_solve(const BlockMatrix& matrix, double raise, const Points& right, Points& solution);

  /// Solves A x = `right` again with the last factor: factor_and_solve() must have returned true.
  void solve(const Points& right, Points& solution);

 private:
  /// The factor.
  template <Same<BlockCholesky> S, class Visit>
  friend void visit_members(S& c, const Visit& visit) {
    visit(c.scale_, fixed_size(c.panels_), fixed_size(c.inverse_));
  }

  using Vector = Eigen::Matrix<Number, 3, 1>;
  using Front = FrontLayout::Front;

  // Loosely coupled particles pass on smaller and smaller numbers, down to denormal ones, which are slow. Callers keep a
  // TinyNumbersAreZero alive.
  [[nodiscard]] bool eliminate(const BlockMatrix& matrix, double raise);
  void assemble(std::size_t front, const BlockMatrix& matrix, double raise);
  [[nodiscard]] double take(const Points& right);
  void substitute(const Front& front);
  void substitute_back();
  void give(double scale, Points& solution) const;

  FrontLayout layout_;
  double scale_ = 1.0;           ///< a power of two: scale of the factored matrix relative to the given one
  LargeVector<Number> panels_;   ///< L
  std::vector<Number> inverse_;  ///< 1 / D
  // Scratch of one factor or one solve.
  LargeVector<Number> updates_;
  std::vector<Number> vector_;
  std::vector<Number> below_;
  std::vector<Number> row_;
};

extern template class BlockCholesky<double>;
extern template class BlockCholesky<float>;

}  // namespace sprung
