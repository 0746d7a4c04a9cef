#include "dynamics/integrators/spectral_bounds.h"

#include "dynamics/forces/force.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
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

using Weight = double LinearElement::*;

/// M^-1/2 K M^-1/2, which has the eigenvalues of M^-1 K, of the elements that it keeps. Pinned particles are left out.
class ElementMatrix {
 public:
  /// `weight` is the stiffness or the damping of the elements.
  ElementMatrix(const std::vector<const LinearElement*>& elements, Weight weight, const Scalars& inverse_masses)
      : elements_(elements), weight_(weight), root_(inverse_masses.cwiseSqrt()) {}

  Scalars operator*(const Scalars& y) const {
    Scalars result = Scalars::Zero(y.size());
    for (const LinearElement* element : elements_) {
      double sum = 0.0;
      for (std::size_t k = 0; k < element->count; ++k) {
        sum += element->weights[k] * root_[element->particles[k]] * y[element->particles[k]];
      }
      const double pull = element->*weight_ * sum;
      for (std::size_t k = 0; k < element->count; ++k) {
        result[element->particles[k]] += element->weights[k] * root_[element->particles[k]] * pull;
      }
    }
    return result;
  }

  /// An upper bound: the largest row sum of B^T M^-1 B K, the matrix that acts on elements instead of particles.
  [[nodiscard]] double row_sum_bound() const {
    Scalars sums = Scalars::Zero(root_.size());
    for (const LinearElement* element : elements_) {
      for (std::size_t k = 0; k < element->count; ++k) {
        sums[element->particles[k]] += element->*weight_ * std::abs(element->weights[k]);
      }
    }
    sums.array() *= root_.array().square();
    double bound = 0.0;
    for (const LinearElement* element : elements_) {
      if (element->*weight_ == 0.0) continue;
      double row = 0.0;
      for (std::size_t k = 0; k < element->count; ++k) row += std::abs(element->weights[k]) * sums[element->particles[k]];
      bound = std::max(bound, row);
    }
    return bound;
  }

  [[nodiscard]] const Scalars& root() const { return root_; }

 private:
  const std::vector<const LinearElement*>& elements_;
  Weight weight_;
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
double largest_eigenvalue(const ElementMatrix& matrix) {
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

/// The elements with stiffness that hardly damp motion of this omega [1/s]; `drag` [1/s] damps all.
std::vector<const LinearElement*> hardly_damped(const std::vector<const LinearElement*>& elements, double omega, double drag) {
  std::vector<const LinearElement*> hardly;
  for (const LinearElement* element : elements) {
    if (element->stiffness == 0.0) continue;
    const double rate = element->damping / element->stiffness * omega * omega + drag;
    if (rate < 2.0 * kHardlyDamped * omega) hardly.push_back(element);
  }
  return hardly;
}

/// The elements whose dampers are those of materials, or all others.
std::vector<const LinearElement*> with_dampers(const std::vector<const LinearElement*>& elements, bool of_material) {
  std::vector<const LinearElement*> some;
  std::ranges::copy_if(elements, std::back_inserter(some), [&](const LinearElement* e) { return e->of_material == of_material; });
  return some;
}

/// The smallest damping / stiffness [s] of elements with stiffness; 0 if there is none.
double least_damping_time(const std::vector<const LinearElement*>& elements) {
  double least = kInfinity;
  for (const LinearElement* element : elements) {
    if (element->stiffness > 0.0) least = std::min(least, element->damping / element->stiffness);
  }
  return least < kInfinity ? least : 0.0;
}

/// Of each free particle [1/s]: damping without stiffness, relative to nothing but space.
Scalars drag_rates(const std::vector<const LinearElement*>& elements, const Scalars& inverse_masses) {
  Scalars rates = Scalars::Zero(inverse_masses.size());
  for (const LinearElement* element : elements) {
    if (element->count == 1 && element->stiffness == 0.0) rates[element->particles[0]] += element->damping;
  }
  return rates.cwiseProduct(inverse_masses);
}

}  // namespace

SpectralBounds spectral_bounds(const std::vector<LinearElement>& all, const Scalars& inverse_masses) {
  std::vector<const LinearElement*> elements;
  for (const LinearElement& element : all) elements.push_back(&element);
  const auto largest = [&](const std::vector<const LinearElement*>& of, Weight weight) {
    return largest_eigenvalue(ElementMatrix(of, weight, inverse_masses));
  };
  SpectralBounds bounds{.elastic = largest(elements, &LinearElement::stiffness),
                        .damping = largest(with_dampers(elements, false), &LinearElement::damping),
                        .material_damping = largest(with_dampers(elements, true), &LinearElement::damping),
                        .damping_time = least_damping_time(elements)};
  if (bounds.material_damping > 0.0) bounds.all_damping = largest(elements, &LinearElement::damping);
  const Scalars rates = drag_rates(elements, inverse_masses);
  bounds.least_drag = kInfinity;
  for (Index i = 0; i < inverse_masses.size(); ++i) {
    if (inverse_masses[i] == 0.0) continue;
    bounds.drag = std::max(bounds.drag, rates[i]);
    bounds.least_drag = std::min(bounds.least_drag, rates[i]);
  }
  if (bounds.least_drag == kInfinity) bounds.least_drag = 0.0;
  bounds.undamped = largest(hardly_damped(elements, std::sqrt(bounds.elastic), bounds.least_drag), &LinearElement::stiffness);
  return bounds;
}

SpectralBounds quick_bounds(const std::vector<LinearElement>& all, const Scalars& inverse_masses) {
  std::vector<const LinearElement*> elements;
  for (const LinearElement& element : all) elements.push_back(&element);
  const auto bound = [&](const std::vector<const LinearElement*>& of, Weight weight) {
    return ElementMatrix(of, weight, inverse_masses).row_sum_bound();
  };
  return {.elastic = bound(elements, &LinearElement::stiffness),
          .damping = bound(with_dampers(elements, false), &LinearElement::damping),
          .material_damping = bound(with_dampers(elements, true), &LinearElement::damping),
          .all_damping = bound(elements, &LinearElement::damping)};
}

}  // namespace sprung
