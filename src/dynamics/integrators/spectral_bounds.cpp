#include "dynamics/integrators/spectral_bounds.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lanczos ends when the residual is this fraction of the estimate. The residual bounds the distance to an eigenvalue.
constexpr double kResidual = 0.01;
constexpr int kMostIterations = 100;

// A start vector without a component in the fastest mode would have a misleading residual. This margin is always added.
constexpr double kMargin = 1.005;

/// M^-1/2 L M^-1/2, which has the eigenvalues of M^-1 L, of the springs with non-zero weight. Pinned particles are left out.
class Laplacian {
 public:
  Laplacian(const SpringNetwork& network, const std::vector<double>& weights)
      : springs_(network.springs), weights_(weights), root_(network.inverse_masses.cwiseSqrt()) {}

  Scalars operator*(const Scalars& y) const {
    Scalars result = Scalars::Zero(y.size());
    for (std::size_t s = 0; s < weights_.size(); ++s) {
      const Index a = springs_.first[s];
      const Index b = springs_.second[s];
      const double pull = weights_[s] * (root_[a] * y[a] - root_[b] * y[b]);
      result[a] += root_[a] * pull;
      result[b] -= root_[b] * pull;
    }
    return result;
  }

  /// An upper bound: the largest row sum of K B^T M^-1 B, the matrix that acts on springs instead of particles.
  [[nodiscard]] double row_sum_bound() const {
    Scalars diagonal = Scalars::Zero(root_.size());
    for (std::size_t s = 0; s < weights_.size(); ++s) {
      diagonal[springs_.first[s]] += weights_[s];
      diagonal[springs_.second[s]] += weights_[s];
    }
    diagonal.array() *= root_.array().square();
    double bound = 0.0;
    for (std::size_t s = 0; s < weights_.size(); ++s) {
      if (weights_[s] > 0.0) bound = std::max(bound, diagonal[springs_.first[s]] + diagonal[springs_.second[s]]);
    }
    return bound;
  }

  [[nodiscard]] const Scalars& root() const { return root_; }

 private:
  const Springs& springs_;
  const std::vector<double>& weights_;
  Scalars root_;
};

/// M^-1/2 K M^-1/2 of straight angle bends: the sum of w^T w weighted by stiffness or damping, w = (1/a, -1/a - 1/b, 1/b) with
/// bonds a and b at rest. No bent configuration with such bonds has a faster mode: no entry of w grows, and the signs already
/// alternate.
class AngleBendMatrix {
 public:
  AngleBendMatrix(const SpringNetwork& network, const std::vector<double>& weights)
      : bends_(network.angle_bends), weights_(weights), root_(network.inverse_masses.cwiseSqrt()) {}

  Scalars operator*(const Scalars& y) const {
    Scalars result = Scalars::Zero(y.size());
    for (std::size_t e = 0; e < weights_.size(); ++e) {
      const Eigen::Array3d scale = turns(e) * root_of(e);
      const double turn =
          weights_[e] * (scale[0] * y[bends_.before[e]] - scale[1] * y[bends_.middle[e]] + scale[2] * y[bends_.after[e]]);
      result[bends_.before[e]] += scale[0] * turn;
      result[bends_.middle[e]] -= scale[1] * turn;
      result[bends_.after[e]] += scale[2] * turn;
    }
    return result;
  }

  /// An upper bound: the largest row sum of M^-1 |K|.
  [[nodiscard]] double row_sum_bound() const {
    Scalars sums = Scalars::Zero(root_.size());
    for (std::size_t e = 0; e < weights_.size(); ++e) {
      const Eigen::Array3d turn = turns(e);
      const double all = weights_[e] * (turn * (root_of(e) > 0.0).cast<double>()).sum();
      sums[bends_.before[e]] += turn[0] * all;
      sums[bends_.middle[e]] += turn[1] * all;
      sums[bends_.after[e]] += turn[2] * all;
    }
    return sums.size() > 0 ? (sums.array() * root_.array().square()).maxCoeff() : 0.0;
  }

  [[nodiscard]] const Scalars& root() const { return root_; }

 private:
  [[nodiscard]] Eigen::Array3d turns(std::size_t e) const {
    const double before = 1.0 / bends_.length_before[e];
    const double after = 1.0 / bends_.length_after[e];
    return {before, before + after, after};
  }
  [[nodiscard]] Eigen::Array3d root_of(std::size_t e) const {
    return {root_[bends_.before[e]], root_[bends_.middle[e]], root_[bends_.after[e]]};
  }

  const AngleBends& bends_;
  const std::vector<double>& weights_;
  Scalars root_;
};

/// The same vector in every run. Zero for pinned particles, so that iterations stay among the free ones.
Scalars start_vector(const Scalars& root) {
  std::mt19937 random;  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same bits in every run are intended
  Scalars y(root.size());
  for (Index i = 0; i < y.size(); ++i) {
    const double uniform = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    y[i] = root[i] > 0.0 ? 2.0 * uniform - 1.0 : 0.0;
  }
  return y;
}

/// Lanczos' method: power iteration that stores the tridiagonal matrix of its iterates.
template <class Matrix>
double largest_eigenvalue(const Matrix& matrix) {
  const double bound = matrix.row_sum_bound();
  Scalars y = start_vector(matrix.root());
  if (bound == 0.0 || y.isZero(0.0)) return 0.0;
  y.normalize();
  Scalars previous = Scalars::Zero(y.size());
  Scalars diagonal(kMostIterations);
  Scalars beside(kMostIterations);
  double estimate = 0.0;
  for (int k = 0; k < kMostIterations; ++k) {
    Scalars next = matrix * y;
    diagonal[k] = y.dot(next);
    next -= diagonal[k] * y;
    if (k > 0) next -= beside[k - 1] * previous;
    beside[k] = next.norm();
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal.head(k + 1), beside.head(k));
    const double residual = beside[k] * std::abs(solver.eigenvectors()(k, k));
    estimate = solver.eigenvalues()[k] + residual;
    if (residual <= kResidual * estimate || beside[k] <= std::numeric_limits<double>::epsilon() * bound) break;
    previous = std::exchange(y, next / beside[k]);
  }
  return std::min(bound, kMargin * estimate);
}

/// The stiffness of springs that hardly damp motion of this omega [1/s], and 0 for the others; `drag` [1/s] damps all.
std::vector<double> hardly_damped(const std::vector<double>& stiffness, const std::vector<double>& damping, double omega,
                                  double drag) {
  std::vector<double> weights(stiffness.size(), 0.0);
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const double rate = stiffness[i] > 0.0 ? damping[i] / stiffness[i] * omega * omega + drag : kInfinity;
    if (rate < 2.0 * kHardlyDamped * omega) weights[i] = stiffness[i];
  }
  return weights;
}

/// The smallest damping / stiffness [s] of elements with stiffness; infinity if there is none.
double least_damping_time(const std::vector<double>& stiffness, const std::vector<double>& damping) {
  double least = kInfinity;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    if (stiffness[i] > 0.0) least = std::min(least, damping[i] / stiffness[i]);
  }
  return least;
}

}  // namespace

SpectralBounds spectral_bounds(const SpringNetwork& network, double drag) {
  const Springs& springs = network.springs;
  const AngleBends& bends = network.angle_bends;
  const auto largest = [&](const std::vector<double>& of_springs, const std::vector<double>& of_bends) {
    return largest_eigenvalue(Laplacian(network, of_springs)) + largest_eigenvalue(AngleBendMatrix(network, of_bends));
  };
  SpectralBounds bounds{.elastic = largest(springs.stiffness, bends.stiffness), .damping = largest(springs.damping, bends.damping)};
  const double least =
      std::min(least_damping_time(springs.stiffness, springs.damping), least_damping_time(bends.stiffness, bends.damping));
  bounds.damping_time = least < kInfinity ? least : 0.0;
  bounds.least_drag = kInfinity;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_pinned(i)) continue;
    const double rate = drag * network.drag_areas[i] * network.inverse_masses[i];
    bounds.drag = std::max(bounds.drag, rate);
    bounds.least_drag = std::min(bounds.least_drag, rate);
  }
  if (bounds.least_drag == kInfinity) bounds.least_drag = 0.0;
  const double omega = std::sqrt(bounds.elastic);
  bounds.undamped = largest(hardly_damped(springs.stiffness, springs.damping, omega, bounds.least_drag),
                            hardly_damped(bends.stiffness, bends.damping, omega, bounds.least_drag));
  return bounds;
}

}  // namespace sprung
