// Dense copies of matrices of 3 x 3 blocks, for reference solvers and formulas.
#pragma once

#include "dynamics/numerics/block_matrix.h"
#include "dynamics/stretch_newton/stretch_system.h"

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

/// M + K as a dense matrix, by the definition.
inline Eigen::MatrixXd dense(const StretchComponent& component, const StretchSystem& system) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * component.free_count, 3 * component.free_count);
  for (Index i = 0; i < component.free_count; ++i) {
    matrix.block<3, 3>(3 * i, 3 * i) += component.masses[i] * Matrix3::Identity();
  }
  for (std::size_t s = 0; s < component.links.size(); ++s) {
    const auto& [a, b, rest_length, spring] = component.links[s];
    const Matrix3 block = system.blocks[s].matrix();
    matrix.block<3, 3>(3 * a, 3 * a) += block;
    if (!component.is_free(b)) continue;
    matrix.block<3, 3>(3 * b, 3 * b) += block;
    matrix.block<3, 3>(3 * a, 3 * b) -= block;
    matrix.block<3, 3>(3 * b, 3 * a) -= block;
  }
  return matrix;
}

}  // namespace sprung
