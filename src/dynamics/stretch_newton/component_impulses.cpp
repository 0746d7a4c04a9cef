#include "dynamics/stretch_newton/component_impulses.h"

#include "base/machine/tiny_numbers.h"

#include <cstddef>
#include <utility>

namespace sprung {
namespace {

// Stiffness of links below their limit, and of all links across their directions, relative to that of links at their limit.
constexpr double kSlack = 1.0e-3;
constexpr double kAcross = 1.0e-6;

// Raises of the diagonal if rounding leaves the matrix of a long, straight body not positive definite.
constexpr double kFirstRaise = 1.0e-12;
constexpr double kLastRaise = 1.0e-2;

bool is_tree_with_one_pin(const StretchComponent& component) {
  for (Index i = 0; i < component.free_count; ++i) {
    if (component.begin[i + 1] - component.begin[i] != 1) return false;
  }
  return true;
}

}  // namespace

ComponentImpulses::ComponentImpulses(StretchComponent component, const StretchLimitSettings& settings)
    : component_(std::move(component)), settings_(settings), hangs_on_one_(is_tree_with_one_pin(component_)) {}

void ComponentImpulses::record(const Points& target, const Points& positions, const ImpulseRecorder& recorder) {
  Points momenta(3, component_.free_count);
  for (Index i = 0; i < component_.free_count; ++i) {
    momenta.col(i) = component_.masses[i] * (position(i, positions) - position(i, target));
  }
  if (momenta.isZero(0.0)) return;
  const Points of_links = hangs_on_one_ ? along_tree(std::move(momenta)) : as_elastic(momenta, positions);
  for (std::size_t l = 0; l < component_.links.size(); ++l) {
    const StretchComponent::Link& link = component_.links[l];
    const Vector3 direction = (position(link.second, positions) - position(link.first, positions)).stableNormalized();
    recorder.add_to_spring(link.spring, direction.dot(of_links.col(l)));
    if (!component_.is_free(link.second)) recorder.add_to_pinned(component_.points[link.second], -of_links.col(l));
  }
}

/// The momenta that links give to their first points [kg m], 3 x links.
Points ComponentImpulses::along_tree(Points momenta) const {
  for (Index i = 0; i < component_.free_count; ++i) {
    const Index second = component_.links[i].second;
    if (component_.is_free(second)) momenta.col(second) += momenta.col(i);
  }
  return momenta;
}

/// The same. Scaling the stiffness of all links scales displacements but not impulses.
Points ComponentImpulses::as_elastic(const Points& momenta, const Points& positions) {
  if (!factor_) {
    std::vector<ParticlePair> pairs;
    for (const StretchComponent::Link& link : component_.links) {
      if (component_.is_free(link.second)) pairs.push_back({link.first, link.second});
    }
    matrix_ = BlockMatrix(component_.free_count, pairs);
    factor_ = std::make_unique<BlockCholesky<double>>(matrix_);
  }
  const TinyNumbersAreZero tiny_numbers_are_zero;
  matrix_.set_zero();
  std::vector<Matrix3> stiffness;
  stiffness.reserve(component_.links.size());
  const double limit = 1.0 + settings_.max_stretch - settings_.tolerance;
  for (const StretchComponent::Link& link : component_.links) {
    const Vector3 between = position(link.second, positions) - position(link.first, positions);
    const Vector3 direction = between.stableNormalized();
    const double along = between.norm() >= limit * link.rest_length ? 1.0 : kSlack;
    const Matrix3 across = kAcross * Matrix3::Identity();
    stiffness.push_back(1.0 / link.rest_length * (across + (along - kAcross) * direction * direction.transpose()));
    if (component_.is_free(link.second)) {
      matrix_.add_difference(link.first, link.second, stiffness.back());
    } else {
      matrix_.add(link.first, link.first, stiffness.back());
    }
  }
  if (component_.pin_count() == 0) matrix_.add(0, 0, matrix_.diagonal(0).trace() * Matrix3::Identity());  // nothing hangs on it
  Points moved = Points::Zero(3, component_.free_count);
  for (double raise = 0.0; raise <= kLastRaise; raise = raise == 0.0 ? kFirstRaise : 100.0 * raise) {
    if (factor_->factor_and_solve(matrix_, raise, momenta, moved)) break;
  }
  Points of_links(3, static_cast<Eigen::Index>(component_.links.size()));
  for (std::size_t l = 0; l < component_.links.size(); ++l) {
    const StretchComponent::Link& link = component_.links[l];
    Vector3 apart = moved.col(link.first);
    if (component_.is_free(link.second)) apart -= moved.col(link.second);
    of_links.col(static_cast<Eigen::Index>(l)) = stiffness[l] * apart;
  }
  return of_links;
}

}  // namespace sprung
