// A direct solver for sparse symmetric matrices of 3 x 3 blocks.
#pragma once

#include "base/huge_pages.h"
#include "dynamics/numerics/block_matrix.h"
#include "dynamics/numerics/front_layout.h"

#include <vector>

namespace sprung {

/// L D L^T of a positive definite matrix, eliminated by supernodes as dense work (multifrontal: Duff and Reid 1983), in double or
/// single precision (Number). Order and pattern are found once. One thread. Matrices and vectors times powers of two have the same
/// bits.
template <class Number>
class BlockCholesky {
 public:
  /// For matrices of the same pairs as `pattern`, without the rows and columns of the particles of which `left_out` has the flag;
  /// none has when it is empty.
  explicit BlockCholesky(const BlockMatrix& pattern, const std::vector<bool>& left_out = {});

  /// Factors the matrix with its diagonal numbers made larger by the part `raise` of them. Returns whether that is positive
  /// definite, as far as rounding tells. Before `solve`, which is not to be called when not.
  [[nodiscard]] bool factor(const BlockMatrix& matrix, double raise = 0.0);

  /// Writes x of A x = `right`, 3 x particles, to `solution`, which may be the same; zero for what is left out.
  void solve(const Points& right, Points& solution);

  /// Both, with the same bits, and less to read: half of the solve is made on the way. Writes no solution where it returns false.
  [[nodiscard]] bool factor_and_solve(const BlockMatrix& matrix, double raise, const Points& right, Points& solution);

 private:
  using Part = Eigen::Matrix<Number, 3, 1>;
  using Front = FrontLayout::Front;

  // Where springs hardly push, what one particle hands on to the next falls off until it is next to nothing: all of this is to be
  // done with TinyNumbersAreZero.
  template <class AndThen>
  [[nodiscard]] bool eliminate(const BlockMatrix& matrix, double raise, const AndThen& and_then);
  void assemble(std::size_t front, const BlockMatrix& matrix, double raise);
  [[nodiscard]] double take(const Points& right);
  void substitute(const Front& front);
  void substitute_back();
  void give(double scale, Points& solution) const;

  FrontLayout layout_;
  double scale_ = 1.0;           ///< of the matrix that was factored to the one that was given, a power of two
  LargeVector<Number> panels_;   ///< L
  std::vector<Number> inverse_;  ///< 1 / D
  // Of a factor or a solve.
  LargeVector<Number> updates_;
  std::vector<Number> vector_;
  std::vector<Number> below_;
  std::vector<Number> row_;
};

extern template class BlockCholesky<double>;
extern template class BlockCholesky<float>;

}  // namespace sprung
