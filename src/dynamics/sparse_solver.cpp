#include "dynamics/sparse_solver.h"

#include <limits>
#include <vector>

namespace sprung {
namespace {

// A factor takes as long as seven solves with it.
constexpr int kMostIterations = 8;

// Sizes are those of residuals, squared, as the factor at hand measures them: a tenth is left of the first at the end.
constexpr double kNearEnough = 0.01;

// A factor that is worth something takes more off in each iteration.
constexpr double kSlowest = 0.8;

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

double SparseSolver::solve(const StretchSystem& system, Points& step) {
  assemble(system);
  if (factored_ && system.is_like_last) {
    if (const auto left = approach(system.residual, step)) return *left;
  }
  factored_ = factor_.factor(matrix_);
  if (factored_) {
    factor_.solve(system.residual, step);
  } else {
    step.setConstant(3, component_.free_count, std::numeric_limits<double>::quiet_NaN());
  }
  return 0.0;
}

/// Conjugate gradients with the factor that is there as preconditioner. Returns what they left to gain, if that is little enough.
std::optional<double> SparseSolver::approach(const Points& right, Points& step) {
  step.setZero(3, component_.free_count);
  left_ = right;
  double first = 0.0;
  double before = 0.0;
  for (int iteration = 0; iteration <= kMostIterations; ++iteration) {
    factor_.solve(left_, towards_);
    const double size = left_.cwiseProduct(towards_).sum();
    if (iteration == 0) {
      first = size;
      direction_ = towards_;
    } else {
      if (size <= kNearEnough * first) return 0.5 * size;
      if (!(size <= kSlowest * before)) return std::nullopt;
      direction_ = towards_ + size / before * direction_;
    }
    before = size;
    pushed_.setZero(3, component_.free_count);
    matrix_.add_product(direction_, 1.0, pushed_);
    const double length = size / direction_.cwiseProduct(pushed_).sum();
    step += length * direction_;
    left_ -= length * pushed_;
  }
  return std::nullopt;
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

}  // namespace sprung
