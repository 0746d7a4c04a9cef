// A matrix of 3 x 3 blocks in full, for solvers and formulas that know nothing of blocks.
#pragma once

#include "dynamics/block_matrix.h"

#include <Eigen/Core>

namespace sprung {

inline Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3 * matrix.size(), 3 * matrix.size());
  for (Index j = 0; j < matrix.size(); ++j) {
    full.block<3, 3>(3 * j, 3 * j) = matrix.diagonal(j);
    matrix.for_column(j, [&](Index i, const Matrix3& block) {
      full.block<3, 3>(3 * i, 3 * j) = block;
      full.block<3, 3>(3 * j, 3 * i) = block.transpose();
    });
  }
  return full;
}

}  // namespace sprung
