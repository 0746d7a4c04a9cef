#include "dynamics/implicit_system.h"

#include <Eigen/SparseCholesky>

#include <limits>
#include <vector>

namespace sprung {
namespace {

// What is held weighs so many times what its particle's equations do: they move it by a millionth, and 10 digits remain.
constexpr double kHoldWeight = 1 << 20;

}  // namespace

struct ImplicitSystem::Factor {
  Eigen::SparseMatrix<double> matrix;  // its lower half
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
  Scalars right;
};

ImplicitSystem::ImplicitSystem(const SpringNetwork& network, const ForceDerivatives& derivatives)
    : network_(network), blocks_(derivatives.by_position), factor_(std::make_unique<Factor>()) {
  for (Index i = 0; i < network.particle_count(); ++i) unknown_.push_back(network.is_pinned(i) ? kNone : free_count_++);
  if (free_count_ > 0) analyze();
}

ImplicitSystem::~ImplicitSystem() = default;

void ImplicitSystem::analyze() {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < blocks_.size(); ++j) {
    const Index column = unknown_[static_cast<std::size_t>(j)];
    if (column == kNone) continue;
    const auto add_block = [&](Index row) {
      for (Index c = 0; c < 3; ++c) {
        for (Index r = row == column ? c : 0; r < 3; ++r) entries.emplace_back(3 * row + r, 3 * column + c, 1.0);
      }
    };
    add_block(column);
    blocks_.for_column(j, [&](Index i, const Matrix3&) {
      if (!network_.is_pinned(i)) add_block(unknown_[static_cast<std::size_t>(i)]);
    });
  }
  Eigen::SparseMatrix<double>& matrix = factor_->matrix;
  matrix.resize(3 * free_count_, 3 * free_count_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_->cholesky.analyzePattern(matrix);
}

// Free particles are numbered in their order, so the matrix keeps the columns and rows of the blocks in theirs.
void ImplicitSystem::fill() {
  double* value = factor_->matrix.valuePtr();
  for (Index j = 0; j < blocks_.size(); ++j) {
    if (network_.is_pinned(j)) continue;
    for (Index c = 0; c < 3; ++c) {
      for (Index r = c; r < 3; ++r) *value++ = blocks_.diagonal(j)(r, c);
      blocks_.for_column(j, [&](Index i, const Matrix3& block) {
        if (network_.is_pinned(i)) return;
        for (Index r = 0; r < 3; ++r) *value++ = block(r, c);
      });
    }
  }
}

void ImplicitSystem::assemble(const ForceDerivatives& derivatives, double dt) {
  blocks_.set_zero();
  for (Index i = 0; i < blocks_.size(); ++i) blocks_.add(i, i, network_.masses[i] * Matrix3::Identity());
  blocks_.add_scaled(derivatives.by_velocity, -dt);
  blocks_.add_scaled(derivatives.by_position, -dt * dt);
}

void ImplicitSystem::hold(Index particle, const Vector3& vector, Points& right) {
  const double length = vector.norm();
  if (length == 0.0) return;
  const Vector3 direction = vector / length;
  const double weight = kHoldWeight * blocks_.diagonal(particle).trace();
  blocks_.add(particle, particle, weight * direction * direction.transpose());
  right.col(particle) += weight * vector;
}

void ImplicitSystem::solve(Points& vectors) {
  if (free_count_ == 0) {
    vectors.setZero();
    return;
  }
  fill();
  Scalars& right = factor_->right;
  right.resize(3 * free_count_);
  for (Index i = 0; i < blocks_.size(); ++i) {
    if (!network_.is_pinned(i)) right.segment<3>(3 * unknown_[static_cast<std::size_t>(i)]) = vectors.col(i);
  }
  factor_->cholesky.factorize(factor_->matrix);
  if (factor_->cholesky.info() == Eigen::Success) {
    right = factor_->cholesky.solve(right).eval();
  } else {
    right.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  for (Index i = 0; i < blocks_.size(); ++i) {
    vectors.col(i).setZero();
    if (!network_.is_pinned(i)) vectors.col(i) = right.segment<3>(3 * unknown_[static_cast<std::size_t>(i)]);
  }
}

}  // namespace sprung
