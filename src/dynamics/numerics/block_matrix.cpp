#include "dynamics/numerics/block_matrix.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sprung {

BlockMatrix::BlockMatrix(Index particles, std::vector<ParticlePair> pairs)
    : diagonal_(static_cast<std::size_t>(particles), Matrix3::Zero()), begin_(static_cast<std::size_t>(particles) + 1) {
  // The first particle of a pair becomes the column, the second the row below the diagonal.
  for (ParticlePair& pair : pairs) {
    if (pair.first > pair.second) std::swap(pair.first, pair.second);
  }
  const auto key = [](const ParticlePair& pair) { return std::tuple(pair.first, pair.second); };
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  pairs.erase(std::unique(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }), pairs.end());
  for (const ParticlePair& pair : pairs) {
    ++begin_[static_cast<std::size_t>(pair.first) + 1];
    rows_.push_back(pair.second);
  }
  for (std::size_t j = 1; j < begin_.size(); ++j) begin_[j] += begin_[j - 1];
  blocks_.assign(rows_.size(), Matrix3::Zero());
}

void BlockMatrix::set_zero() {
  std::fill(diagonal_.begin(), diagonal_.end(), Matrix3::Zero());
  std::fill(blocks_.begin(), blocks_.end(), Matrix3::Zero());
}

void BlockMatrix::add(Index row, Index column, const Matrix3& block) {
  if (row == column) {
    diagonal_[static_cast<std::size_t>(row)] += block;
    return;
  }
  const auto [upper, lower] = std::minmax(row, column);
  const auto j = static_cast<std::size_t>(upper);
  const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j]);
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j + 1]);
  Matrix3& kept = blocks_[static_cast<std::size_t>(std::lower_bound(begin, end, lower) - rows_.begin())];
  if (row > column) {
    kept += block;
  } else {
    kept += block.transpose();
  }
}

void BlockMatrix::add_difference(Index a, Index b, const Matrix3& block) {
  add(a, a, block);
  add(b, b, block);
  add(b, a, -block);
}

void BlockMatrix::add_scaled(const BlockMatrix& other, double factor) {
  for (std::size_t i = 0; i < diagonal_.size(); ++i) diagonal_[i] += factor * other.diagonal_[i];
  for (std::size_t k = 0; k < blocks_.size(); ++k) blocks_[k] += factor * other.blocks_[k];
}

void BlockMatrix::add_product(const Points& vectors, double factor, Points& result) const {
  for (Index j = 0; j < size(); ++j) {
    const Vector3 vector = factor * vectors.col(j);
    Vector3 sum = diagonal(j) * vector;
    for_column(j, [&](Index i, const Matrix3& block) {
      result.col(i) += block * vector;
      sum += factor * (block.transpose() * vectors.col(i));
    });
    result.col(j) += sum;
  }
}

}  // namespace sprung
