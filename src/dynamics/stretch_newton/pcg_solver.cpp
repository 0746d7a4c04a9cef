#include "dynamics/stretch_newton/pcg_solver.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// A factor takes as long as six to eight solves with it. A useful factor reduces the error in each iteration. With a raised
// diagonal, weakly constrained modes converge last, and an iteration may increase the error.
constexpr int kMostIterations = 8;
constexpr double kSlowest = 0.8;
constexpr int kMostIterationsRaised = 16;
constexpr double kSlowestRaised = std::numeric_limits<double>::infinity();

// Rounding units of single precision; with half as many some diagonals of cloths became negative.
constexpr double kRaise = 4.0 * 0x1p-24;

// On squared residuals in the factor's norm: with an exact factor, less than a tenth of the initial error remains.
constexpr double kNearEnough = 0.01;

// In the norm of the masses, which mostly overestimates it.
constexpr double kSurelyNear = 1.0e-4;

// Single precision is not tried again above this fraction of the stiffness at which it failed, relative to the masses.
constexpr double kBearableFraction = 0.5;

BlockMatrix pattern_of(const StretchComponent& component) {
  std::vector<ParticlePair> pairs;
  for (const auto& link : component.links) {
    if (component.is_free(link.second)) pairs.push_back({.first = link.first, .second = link.second});
  }
  for (const auto& rod : component.rods) {
    for (std::size_t k = 1; k < rod.count; ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (component.is_free(rod.points[j]) && component.is_free(rod.points[k])) pairs.push_back({rod.points[j], rod.points[k]});
      }
    }
  }
  return {component.free_count, pairs};
}

}  // namespace

PcgSolver::PcgSolver(const StretchComponent& component)
    : component_(component),
      matrix_(pattern_of(component)),
      rough_(matrix_),
      attempts_{Attempt{.raise = 0.0, .patience = {.most_iterations = kMostIterations, .slowest = kSlowest}},
                Attempt{.raise = kRaise, .patience = {.most_iterations = kMostIterationsRaised, .slowest = kSlowestRaised}}} {}

double PcgSolver::solve(const StretchSystem& system, Points& step) {
  assemble(system);
  // Rods are far stiffer than links: single precision rarely suffices. Each iteration changes which links carry the load: conjugate
  // gradients with the factor of the step's first iteration took as long as new factors (a hammock of 41 x 21 particles).
  if (!component_.rods.empty()) {
    solve_exactly(system.residual, step);
    return 0.0;
  }
  if (system.is_like_last) {
    if (const auto left = solve_as_last(system, step)) return *left;
  }
  const double stiffness = stiffest();
  for (Attempt& attempt : attempts_) {
    if (!(stiffness < attempt.bearable)) continue;
    kept_ = rough_.factor_and_solve(matrix_, attempt.raise, system.residual, preconditioned_) ? Kept::rough : Kept::nothing;
    if (const auto left = approach_with_kept(attempt.patience, system.residual, step)) return *left;
    attempt.bearable = kBearableFraction * stiffness;
  }
  solve_exactly(system.residual, step);
  return 0.0;
}

void PcgSolver::solve_again(const StretchSystem& system, Points& step) {
  if (kept_ == Kept::nothing) {
    step.setZero(3, component_.free_count);
    return;
  }
  solve_with_kept(system.residual, step);
  if (component_.pin_count() == 0 && component_.rods.empty()) keep_momentum(system.residual, step);
}

void PcgSolver::forget() {
  kept_ = Kept::nothing;
  last_factor_failed_ = false;
  for (Attempt& attempt : attempts_) attempt.bearable = std::numeric_limits<double>::infinity();
}

void PcgSolver::save(ByteWriter& to) const {
  to.write(kept_);
  if (kept_ == Kept::rough) to.write(rough_);
  if (kept_ == Kept::exact) to.write(*exact_);
  for (const Attempt& attempt : attempts_) to.write(attempt.bearable);
  to.write(last_factor_failed_);
}

void PcgSolver::load(BinaryReader& from) {
  from.read(kept_);
  if (kept_ == Kept::exact && !exact_) exact_ = std::make_unique<BlockCholesky<double>>(matrix_);
  if (kept_ == Kept::rough) from.read(rough_);
  if (kept_ == Kept::exact) from.read(*exact_);
  for (Attempt& attempt : attempts_) from.read(attempt.bearable);
  from.read(last_factor_failed_);
}

std::optional<double> PcgSolver::solve_as_last(const StretchSystem& system, Points& step) {
  // A system that changes this fast mostly does so the next time too.
  if (std::exchange(last_factor_failed_, false)) return std::nullopt;
  const Patience patience{.most_iterations = kMostIterations, .slowest = kSlowest, .may_be_left = system.may_be_left};
  solve_with_kept(system.residual, preconditioned_);
  const auto left = approach_with_kept(patience, system.residual, step);
  last_factor_failed_ = !left;
  return left;
}

void PcgSolver::solve_with_kept(const Points& right, Points& solution) {
  if (kept_ == Kept::rough) {
    rough_.solve(right, solution);
  } else if (kept_ == Kept::exact) {
    exact_->solve(right, solution);
  }
}

// Links push both ends equally, so the common motion has an equation of its own, which is solved exactly.
void PcgSolver::keep_momentum(const Points& right, Points& step) const {
  Vector3 missing = right.rowwise().sum();
  double mass = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) {
    missing -= component_.masses[i] * step.col(i);
    mass += component_.masses[i];
  }
  step.colwise() += missing / mass;
}

std::optional<double> PcgSolver::approach_with_kept(const Patience& patience, const Points& right, Points& step) {
  if (kept_ == Kept::nothing) return std::nullopt;
  const auto left = approach(patience, right, step);
  if (left && component_.pin_count() == 0) keep_momentum(right, step);
  return left;
}

/// Conjugate gradients preconditioned by the kept factor. `preconditioned_` is its solution for `right`, the first direction.
/// Returns the remaining gain if that is small enough.
std::optional<double> PcgSolver::approach(const Patience& patience, const Points& right, Points& step) {
  step.setZero(3, component_.free_count);
  residual_ = right;
  double gained = 0.0;
  double before = 0.0;
  for (int iteration = 1; iteration <= patience.most_iterations; ++iteration) {
    if (iteration > 1) solve_with_kept(residual_, preconditioned_);
    const double size = residual_.cwiseProduct(preconditioned_).sum();
    if (size == 0.0) return 0.0;
    if (iteration == 1) {
      direction_ = preconditioned_;
    } else {
      if (!(size <= patience.slowest * before)) return std::nullopt;
      direction_ = preconditioned_ + size / before * direction_;
    }
    before = size;
    product_.setZero(3, component_.free_count);
    matrix_.add_product(direction_, 1.0, product_);
    const double length = size / direction_.cwiseProduct(product_).sum();
    gained += length * size;
    step += length * direction_;
    residual_ -= length * product_;
    // Takes the step before its end would be measured: it costs less than measuring, and the error only decreases.
    if (0.5 * size <= patience.may_be_left || (iteration > 1 && size <= kNearEnough * gained)) return 0.5 * size;
    if (const double most = largest_size(); most <= kSurelyNear * gained) return 0.5 * most;
  }
  return std::nullopt;
}

/// Largest stiffness of a particle relative to its mass.
double PcgSolver::stiffest() const {
  double most = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) most = std::max(most, matrix_.diagonal(i).trace() / component_.masses[i]);
  return most;
}

/// Upper bound on the size of the residual, by masses alone: stiffness only reduces it.
double PcgSolver::largest_size() const {
  double size = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) size += residual_.col(i).squaredNorm() / component_.masses[i];
  return size;
}

void PcgSolver::solve_exactly(const Points& right, Points& step) {
  if (!exact_) exact_ = std::make_unique<BlockCholesky<double>>(matrix_);
  kept_ = exact_->factor_and_solve(matrix_, 0.0, right, step) ? Kept::exact : Kept::nothing;
  if (kept_ == Kept::nothing) step.setConstant(3, component_.free_count, std::numeric_limits<double>::quiet_NaN());
}

void PcgSolver::assemble(const StretchSystem& system) {
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
  for (std::size_t r = 0; r < component_.rods.size(); ++r) {
    const StretchComponent::Rod& rod = component_.rods[r];
    const RodRow& row = system.rows[rod.number];
    const Matrix3 block = system.of_rods[r].matrix();
    for (std::size_t k = 0; k < rod.count; ++k) {
      for (std::size_t j = 0; j <= k; ++j) {
        if (!component_.is_free(rod.points[j]) || !component_.is_free(rod.points[k])) continue;
        matrix_.add(rod.points[j], rod.points[k], row.weights[j] * row.weights[k] * block);
      }
    }
  }
}

}  // namespace sprung
