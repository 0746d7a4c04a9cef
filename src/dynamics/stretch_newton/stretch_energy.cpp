#include "dynamics/stretch_newton/stretch_energy.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// A link that carries its component's load exceeds its limit by this fraction of the tolerance; in motion the load is a few times
// larger. Chains and trees that hang on one link are clipped as well; in cloths the load concentrates at the pins.
constexpr double kFractionForChains = 0.25;
constexpr double kFractionForCloths = 0.1;

// Links are near their limit from this fraction of it.
constexpr double kNear = 0.9;

// Springs with stiffness keep most links nearly at their limit. There a link passes half of its excess to each neighbour, and a
// link with more slack than that stays slack. Treating it as pushing cost a cloth 11 iterations a step instead of 2, and solves
// that ended sooner added energy.
constexpr double kPassedOn = 0.5;

// The smallest tolerance that sets the links' stiffness: stiffer links take more iterations.
constexpr double kLeastTolerance = 4.0e-4;

}  // namespace

StretchEnergy::StretchEnergy(const StretchComponent& component, const StretchLimitSettings& settings)
    : component_(component), near_(kNear) {
  const double fraction = component.is_tree ? kFractionForChains : kFractionForCloths;
  const double give = fraction * std::max(settings.tolerance, kLeastTolerance);
  for (const StretchComponent::Link& link : component.links) {
    limits_.push_back({link.rest_length * (1.0 + settings.max_stretch), 1.0 / (give * link.rest_length)});
    give_ = std::max(give_, give * link.rest_length);
  }
}

void StretchEnergy::find_near(const Points& y) {
  if (!component_.is_elastic) return;
  double longest = 1.0;
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const double squared = (y.col(link.second) - y.col(link.first)).squaredNorm();
    longest = std::max(longest, squared / (limits_[s].length * limits_[s].length));
  }
  near_ = std::max(kNear, 1.0 - kPassedOn * (std::sqrt(longest) - 1.0));
}

double StretchEnergy::value(const Points& x, const Points& y) const {
  double inertia = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) inertia += component_.masses[i] * (x.col(i) - y.col(i)).squaredNorm();
  double elastic = 0.0;
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const double squared = (x.col(link.second) - x.col(link.first)).squaredNorm();
    if (squared <= limits_[s].length * limits_[s].length) continue;
    const double excess = std::sqrt(squared) - limits_[s].length;
    elastic += limits_[s].stiffness * excess * excess;
  }
  return 0.5 * (inertia + load_ * elastic);
}

void StretchEnergy::note_overshot(const Points& x) {
  overshot_.resize(limits_.size(), 0);
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const double squared = (x.col(link.second) - x.col(link.first)).squaredNorm();
    if (squared > limits_[s].length * limits_[s].length) overshot_[s] = 1;
  }
}

double StretchEnergy::linearise(const Points& x, const Points& y, NearLimit near, StretchSystem& system) const {
  system.blocks.resize(limits_.size());
  system.residual.resize(Eigen::NoChange, component_.free_count);
  double inertia = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) {
    const Vector3 away = y.col(i) - x.col(i);
    inertia += component_.masses[i] * away.squaredNorm();
    system.residual.col(i) = component_.masses[i] * away;
  }
  double elastic = 0.0;
  const double squared_fraction = near == NearLimit::stiff || near == NearLimit::pushing ? near_ * near_ : 1.0;
  const bool looks_at_overshot = near == NearLimit::overshot && knows_overshot();
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const Limit& limit = limits_[s];
    const Vector3 between = x.col(link.second) - x.col(link.first);
    const double squared = between.squaredNorm();
    const bool is_stiff = looks_at_overshot && overshot_[s] != 0;
    if (!is_stiff && squared <= squared_fraction * limit.length * limit.length) {
      system.blocks[s] = {};
      continue;
    }
    const double length = std::sqrt(squared);
    const Vector3 direction = between / length;
    const double stiffness = load_ * limit.stiffness;
    const double excess = length - limit.length;
    const double across = stiffness * std::max(0.0, excess / length);
    system.blocks[s] = SymmetricMatrix3::along(across, stiffness - across, direction);
    if (excess <= 0.0 && near != NearLimit::pushing) continue;
    const Vector3 pull = stiffness * excess * direction;
    system.residual.col(link.first) += pull;
    if (component_.is_free(link.second)) system.residual.col(link.second) -= pull;
    elastic += stiffness * excess * excess;
  }
  return 0.5 * (inertia + elastic);
}

std::vector<double> StretchEnergy::stiffness_across(const Points& x) const {
  std::vector<double> across;
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const double squared = (x.col(link.second) - x.col(link.first)).squaredNorm();
    const bool pulls = squared > limits_[s].length * limits_[s].length;
    across.push_back(pulls ? load_ * limits_[s].stiffness * (1.0 - limits_[s].length / std::sqrt(squared)) : 0.0);
  }
  return across;
}

void StretchEnergy::take_turning(const Points& x, const Points& tried, StretchSystem& system) const {
  system.residual.setZero();
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    if (system.blocks[s].matrix().trace() == 0.0) continue;
    const StretchComponent::Link& link = component_.links[s];
    const Vector3 between = tried.col(link.second) - tried.col(link.first);
    const double length = between.norm();
    const double excess = length - limits_[s].length;
    if (excess <= 0.0) continue;
    const Vector3 direction = (x.col(link.second) - x.col(link.first)).normalized();
    const double turned = length - direction.dot(between);
    const Vector3 pull = load_ * limits_[s].stiffness * std::min(turned, excess) * direction;
    system.residual.col(link.first) += pull;
    if (component_.is_free(link.second)) system.residual.col(link.second) -= pull;
  }
}

}  // namespace sprung
