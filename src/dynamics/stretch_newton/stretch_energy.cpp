#include "dynamics/stretch_newton/stretch_energy.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// A link that carries its component's load exceeds its limit by this fraction of the tolerance; in motion the load is a few times
// larger. Chains and trees that hang on one link are clipped as well; in cloths the load concentrates at the pins.
constexpr double kFractionForChains = 0.25;
constexpr double kFractionForCloths = 0.1;

// A rod that carries the load is off by this fraction of its tolerance.
constexpr double kFractionForRods = 0.1;

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
  double of_rods = 0.0;
  for (const StretchComponent::Rod& rod : component_.rods) {
    const RodState state = state_of(rod, x);
    of_rods += state.stiffness * state.excess * state.excess;
  }
  return 0.5 * (inertia + load_ * elastic + of_rods);
}

StretchEnergy::RodState StretchEnergy::state_of(const StretchComponent::Rod& rod, const Points& x) const {
  const RodRow& row = rows_[rod.number];
  const Vector3 difference = row.difference(x, [&](std::size_t k) { return rod.points[k]; });
  const double distance = difference.norm();
  RodState state{.distance = distance, .excess = distance - row.length, .stiffness = load_ / (kFractionForRods * row.tolerance)};
  if (distance > 0.0) state.direction = difference / distance;
  return state;
}

Vector3 StretchEnergy::push(const StretchComponent::Rod& rod, const Points& x) const {
  const RodState state = state_of(rod, x);
  return -state.stiffness * state.excess * state.direction;
}

void StretchEnergy::add_push(const StretchComponent::Rod& rod, const Vector3& push, StretchSystem& system) const {
  for (std::size_t k = 0; k < rod.count; ++k) {
    if (component_.is_free(rod.points[k])) system.residual.col(rod.points[k]) += rows_[rod.number].weights[k] * push;
  }
}

/// Returns twice their energy. A rod of length 0 is as stiff across as along it.
double StretchEnergy::linearise_rods(const Points& x, StretchSystem& system) const {
  system.rows = rows_;
  system.of_rods.clear();
  double elastic = 0.0;
  for (const StretchComponent::Rod& rod : component_.rods) {
    const RodState state = state_of(rod, x);
    const bool is_joint = rows_[rod.number].length == 0.0;
    const double across = is_joint ? state.stiffness : state.stiffness * std::max(0.0, state.excess / state.distance);
    system.of_rods.push_back(SymmetricMatrix3::along(across, state.stiffness - across, state.direction));
    add_push(rod, -state.stiffness * state.excess * state.direction, system);
    elastic += state.stiffness * state.excess * state.excess;
  }
  return elastic;
}

std::vector<double> StretchEnergy::pulls(const Points& x) const {
  std::vector<double> pulls;
  for (std::size_t s = 0; s < limits_.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    const double length = (x.col(link.second) - x.col(link.first)).norm();
    pulls.push_back(load_ * limits_[s].stiffness * std::max(0.0, length - limits_[s].length));
  }
  return pulls;
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
  elastic += linearise_rods(x, system);
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
  for (const StretchComponent::Rod& rod : component_.rods) {
    const RodState at_x = state_of(rod, x);
    const RodState at_tried = state_of(rod, tried);
    const double turned = at_tried.distance * (1.0 - at_x.direction.dot(at_tried.direction));
    add_push(rod, -at_tried.stiffness * std::clamp(at_tried.excess, 0.0, turned) * at_x.direction, system);
  }
}

}  // namespace sprung
