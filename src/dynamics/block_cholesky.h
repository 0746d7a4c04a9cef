// A direct solver for sparse symmetric matrices of 3 x 3 blocks.
#pragma once

#include "base/huge_pages.h"
#include "dynamics/block_matrix.h"

#include <memory>
#include <vector>

namespace sprung {

struct FrontLayout;

/// L D L^T of a positive definite matrix, eliminated by supernodes as dense work (multifrontal: Duff and Reid 1983), in double or
/// single precision (Number). Order and pattern are found once. One thread. Matrices and vectors times powers of two have the same
/// bits.
template <class Number>
class BlockCholesky {
 public:
  /// For matrices of the same pairs as `pattern`, without the rows and columns of the particles of which `left_out` has the flag;
  /// none has when it is empty.
  explicit BlockCholesky(const BlockMatrix& pattern, const std::vector<bool>& left_out = {});
  ~BlockCholesky();

  /// Factors the matrix with its diagonal numbers made larger by the part `raise` of them. Returns whether that is positive
  /// definite, as far as rounding tells. Before `solve`, which is not to be called when not.
  [[nodiscard]] bool factor(const BlockMatrix& matrix, double raise = 0.0);

  /// Writes x of A x = `right`, 3 x particles, to `solution`, which may be the same; zero for what is left out.
  void solve(const Points& right, Points& solution);

 private:
  void assemble(std::size_t front, const BlockMatrix& matrix, double raise);

  std::unique_ptr<const FrontLayout> layout_;
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
