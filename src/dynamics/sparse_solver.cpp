#include "dynamics/sparse_solver.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// As many iterations take about as long as a new factor.
constexpr int kMostIterations = 15;

// The part of the first residual, as the preconditioner measures it, at which iterations end: Newton's method corrects the rest.
constexpr double kTolerance = 1.0e-2;

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

/// L D L^T of M + K.
class SparseSolver::Factor {
 public:
  explicit Factor(const StretchComponent& component) : component_(component) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < component.free_count; ++i) add_block(i, i, entries);
    for (const auto& link : component.links) {
      if (component.is_free(link.second)) add_block(link.second, link.first, entries);
    }
    const Eigen::Index size = Eigen::Index{3} * component.free_count;
    matrix_.resize(size, size);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    matrix_.makeCompressed();
    for (const auto& link : component.links) {
      beside_.push_back(component.is_free(link.second) ? place(link.second, link.first) : Place{});
    }
    factor_.analyzePattern(matrix_);
  }

  [[nodiscard]] bool is_made() const { return made_; }
  void forget() { made_ = false; }

  void make(const StretchSystem& system) {
    matrix_.coeffs().setZero();
    for (Index i = 0; i < component_.free_count; ++i) {
      add_to_diagonal(i, SymmetricMatrix3::along(component_.masses[i], 0.0, Vector3::Zero()));
    }
    for (std::size_t s = 0; s < component_.links.size(); ++s) {
      const auto& link = component_.links[s];
      const SymmetricMatrix3& block = system.blocks[s];
      add_to_diagonal(link.first, block);
      if (!component_.is_free(link.second)) continue;
      add_to_diagonal(link.second, block);
      subtract_beside(beside_[s], block);
    }
    factor_.factorize(matrix_);
    made_ = factor_.info() == Eigen::Success;
  }

  void solve(const Points& right, Points& solution) const {
    solution.resize(Eigen::NoChange, right.cols());
    solution.reshaped() = factor_.solve(right.reshaped());
  }

 private:
  /// Where the three columns of a block begin among the values.
  using Place = std::array<Eigen::Index, 3>;

  static void add_block(Index row, Index column, std::vector<Eigen::Triplet<double>>& entries) {
    for (int c = 0; c < 3; ++c) {
      for (int r = row == column ? c : 0; r < 3; ++r) entries.emplace_back(3 * row + r, 3 * column + c, 0.0);
    }
  }

  [[nodiscard]] Place place(Index row, Index column) const {
    Place found{};
    for (int c = 0; c < 3; ++c) {
      const int* const rows = matrix_.innerIndexPtr();
      const auto begin = rows + matrix_.outerIndexPtr()[3 * column + c];
      const auto end = rows + matrix_.outerIndexPtr()[3 * column + c + 1];
      found[c] = std::lower_bound(begin, end, 3 * row) - rows;
    }
    return found;
  }

  void add_to_diagonal(Index i, const SymmetricMatrix3& block) {
    double* const values = matrix_.valuePtr();
    const int* const begin = matrix_.outerIndexPtr() + Eigen::Index{3} * i;
    values[begin[0]] += block.xx;
    values[begin[0] + 1] += block.xy;
    values[begin[0] + 2] += block.xz;
    values[begin[1]] += block.yy;
    values[begin[1] + 1] += block.yz;
    values[begin[2]] += block.zz;
  }

  void subtract_beside(const Place& at, const SymmetricMatrix3& block) {
    double* const values = matrix_.valuePtr();
    values[at[0]] -= block.xx;
    values[at[0] + 1] -= block.xy;
    values[at[0] + 2] -= block.xz;
    values[at[1]] -= block.xy;
    values[at[1] + 1] -= block.yy;
    values[at[1] + 2] -= block.yz;
    values[at[2]] -= block.xz;
    values[at[2] + 1] -= block.yz;
    values[at[2] + 2] -= block.zz;
  }

  const StretchComponent& component_;
  Eigen::SparseMatrix<double> matrix_;  ///< the lower triangle
  std::vector<Place> beside_;           ///< of links
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool made_ = false;
};

SparseSolver::SparseSolver(const StretchComponent& component)
    : component_(component), factor_(std::make_unique<Factor>(component)) {}
SparseSolver::~SparseSolver() = default;

void SparseSolver::begin_step() { factor_->forget(); }

void SparseSolver::solve(const StretchSystem& system, Points& step) {
  if (factor_->is_made() && conjugate_gradients(system, step)) return;
  factor_->make(system);
  factor_->solve(system.residual, step);
}

bool SparseSolver::conjugate_gradients(const StretchSystem& system, Points& step) {
  step.setZero(3, component_.free_count);
  residual_ = system.residual;
  factor_->solve(residual_, preconditioned_);
  direction_ = preconditioned_;
  double squared = dot(residual_, preconditioned_);
  const double enough = kTolerance * kTolerance * squared;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    multiply(system, direction_, product_);
    const double along = squared / dot(direction_, product_);
    step += along * direction_;
    residual_ -= along * product_;
    factor_->solve(residual_, preconditioned_);
    const double last = std::exchange(squared, dot(residual_, preconditioned_));
    if (squared <= enough) return true;
    direction_ = preconditioned_ + squared / last * direction_;
  }
  return false;
}

void SparseSolver::multiply(const StretchSystem& system, const Points& direction, Points& product) const {
  product.resize(Eigen::NoChange, component_.free_count);
  for (Index i = 0; i < component_.free_count; ++i) product.col(i) = component_.masses[i] * direction.col(i);
  for (std::size_t s = 0; s < component_.links.size(); ++s) {
    const auto& link = component_.links[s];
    if (!component_.is_free(link.second)) {
      product.col(link.first) += system.blocks[s] * direction.col(link.first);
      continue;
    }
    const Vector3 pull = system.blocks[s] * (direction.col(link.first) - direction.col(link.second));
    product.col(link.first) += pull;
    product.col(link.second) -= pull;
  }
}

}  // namespace sprung
