#include "dynamics/sparse_solver.h"

#include <utility>
#include <vector>

namespace sprung {
namespace {

// As many iterations take about as long as a new factor.
constexpr int kMostIterations = 15;

// The part of the first residual, as the preconditioner measures it, at which iterations end: Newton's method corrects the rest.
constexpr double kTolerance = 1.0e-2;

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

BlockMatrix pattern_of(const StretchComponent& component) {
  std::vector<ParticlePair> pairs;
  for (const auto& link : component.links) {
    if (component.is_free(link.second)) pairs.push_back({.first = link.first, .second = link.second});
  }
  return {component.free_count, pairs};
}

}  // namespace

SparseSolver::SparseSolver(const StretchComponent& component)
    : component_(component), matrix_(pattern_of(component)), factor_(matrix_) {}

void SparseSolver::begin_step() { is_made_ = false; }

void SparseSolver::solve(const StretchSystem& system, Points& step) {
  if (is_made_ && conjugate_gradients(system, step)) return;
  assemble(system);
  is_made_ = factor_.factor(matrix_);
  factor_.solve(system.residual, step);
}

void SparseSolver::assemble(const StretchSystem& system) {
  matrix_.set_zero();
  for (Index i = 0; i < component_.free_count; ++i) matrix_.add(i, i, component_.masses[i] * Matrix3::Identity());
  for (std::size_t s = 0; s < component_.links.size(); ++s) {
    const auto& link = component_.links[s];
    const Matrix3 block = system.blocks[s].matrix();
    if (component_.is_free(link.second)) {
      matrix_.add_difference(link.first, link.second, block);
    } else {
      matrix_.add(link.first, link.first, block);
    }
  }
}

bool SparseSolver::conjugate_gradients(const StretchSystem& system, Points& step) {
  step.setZero(3, component_.free_count);
  residual_ = system.residual;
  factor_.solve(residual_, preconditioned_);
  direction_ = preconditioned_;
  double squared = dot(residual_, preconditioned_);
  const double enough = kTolerance * kTolerance * squared;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    multiply(system, direction_, product_);
    const double along = squared / dot(direction_, product_);
    step += along * direction_;
    residual_ -= along * product_;
    factor_.solve(residual_, preconditioned_);
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
