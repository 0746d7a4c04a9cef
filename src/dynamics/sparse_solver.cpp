#include "dynamics/sparse_solver.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace sprung {
namespace {

// A factor takes as long as eight solves with it.
constexpr int kMostIterations = 8;

// Sizes are those of residuals, squared, as the factor at hand measures them: less than a tenth is left of the first at the end.
constexpr double kNearEnough = 0.01;

// As the masses measure them, who mostly count it for far too much.
constexpr double kSurelyNear = 1.0e-4;

// A factor that is worth something takes more off in each iteration.
constexpr double kSlowest = 0.8;

// Single precision is not tried again where links are nearly as stiff, beside masses, as once when it failed.
constexpr double kBearablePart = 0.5;

BlockMatrix pattern_of(const StretchComponent& component) {
  std::vector<ParticlePair> pairs;
  for (const auto& link : component.links) {
    if (component.is_free(link.second)) pairs.push_back({.first = link.first, .second = link.second});
  }
  return {component.free_count, pairs};
}

}  // namespace

SparseSolver::SparseSolver(const StretchComponent& component)
    : component_(component), matrix_(pattern_of(component)), rough_(matrix_) {}

double SparseSolver::solve(const StretchSystem& system, Points& step) {
  assemble(system);
  if (system.is_like_last) {
    if (const auto left = approach_as_last(system.residual, step)) return *left;
  }
  if (const double stiffness = stiffest(); stiffness < bearable_) {
    kept_ = rough_.factor(matrix_) ? Kept::rough : Kept::nothing;
    if (const auto left = approach_as_last(system.residual, step)) return *left;
    bearable_ = kBearablePart * stiffness;
  }
  solve_exactly(system.residual, step);
  return 0.0;
}

std::optional<double> SparseSolver::approach_as_last(const Points& right, Points& step) {
  if (kept_ == Kept::nothing) return std::nullopt;
  const auto left = kept_ == Kept::rough ? approach(rough_, right, step) : approach(*exact_, right, step);
  if (left && component_.pin_count() == 0) keep_momentum(right, step);
  return left;
}

// Links push one end as the other: what all move in common has an equation of its own, in which nothing needs to be left.
void SparseSolver::keep_momentum(const Points& right, Points& step) const {
  Vector3 missing = right.rowwise().sum();
  double mass = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) {
    missing -= component_.masses[i] * step.col(i);
    mass += component_.masses[i];
  }
  step.colwise() += missing / mass;
}

/// Conjugate gradients with a factor as preconditioner. Returns what they left to gain, if that is little enough.
template <class Factor>
std::optional<double> SparseSolver::approach(Factor& factor, const Points& right, Points& step) {
  step.setZero(3, component_.free_count);
  left_ = right;
  double first = 0.0;
  double before = 0.0;
  for (int iteration = 1; iteration <= kMostIterations; ++iteration) {
    factor.solve(left_, towards_);
    const double size = left_.cwiseProduct(towards_).sum();
    if (iteration == 1) {
      first = size;
      direction_ = towards_;
    } else {
      if (!(size <= kSlowest * before)) return std::nullopt;
      direction_ = towards_ + size / before * direction_;
    }
    before = size;
    pushed_.setZero(3, component_.free_count);
    matrix_.add_product(direction_, 1.0, pushed_);
    const double length = size / direction_.cwiseProduct(pushed_).sum();
    step += length * direction_;
    left_ -= length * pushed_;
    // The way is made before its end would be measured: it costs less than that, and what is left only falls.
    if (iteration > 1 && size <= kNearEnough * first) return 0.5 * size;
    if (const double most = largest_size(); most <= kSurelyNear * first) return 0.5 * most;
  }
  return std::nullopt;
}

/// Of any particle beside its mass.
double SparseSolver::stiffest() const {
  double most = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) most = std::max(most, matrix_.diagonal(i).trace() / component_.masses[i]);
  return most;
}

/// Of what is left, by masses alone: stiffness only makes it smaller.
double SparseSolver::largest_size() const {
  double size = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) size += left_.col(i).squaredNorm() / component_.masses[i];
  return size;
}

void SparseSolver::solve_exactly(const Points& right, Points& step) {
  if (!exact_) exact_ = std::make_unique<BlockCholesky<double>>(matrix_);
  kept_ = exact_->factor(matrix_) ? Kept::exact : Kept::nothing;
  if (kept_ == Kept::exact) {
    exact_->solve(right, step);
  } else {
    step.setConstant(3, component_.free_count, std::numeric_limits<double>::quiet_NaN());
  }
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
