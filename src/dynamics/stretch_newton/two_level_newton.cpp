#include "dynamics/stretch_newton/two_level_newton.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

// Smaller cloths do not need it: one level solves a hanging cloth of 64 x 64 in less than a millisecond a frame. Two levels take a
// third of the time at 128 x 128.
constexpr Index kLeastParticles = 8192;

// Between coarse points a rotating cloth is longer than they show, by some tenths of a per cent. Passes correct that, but they
// come to rest only where coarse links stay well within the tolerance.
constexpr double kFractionOfTolerance = 0.25;

// Taut regions are straightened by at most this fraction of the fall per step, as by the same fraction of gravity. With the whole
// fall a swinging cloth of 128 x 128 gained 0.4 % of its released energy in steps of 1/960 s; with this fraction a thousandth of a
// per cent.
constexpr double kStraightenedOfFall = 1.0 / 16.0;

StretchLimitSettings coarse_settings(StretchLimitSettings settings) {
  settings.tolerance *= kFractionOfTolerance;
  return settings;
}

Vector3 shortened(const Vector3& displacement, double most) {
  const double length = displacement.norm();
  return length > most ? Vector3(most / length * displacement) : displacement;
}

}  // namespace

TwoLevelNewton::TwoLevelNewton(const StretchComponent& component, CoarseCloth coarse, const StretchLimitSettings& settings)
    : coarse_(std::move(coarse)),
      particles_(component.points.begin(), component.points.begin() + component.free_count),
      masses_(component.masses),
      coarse_masses_(coarse_.particles.size(), 1.0),
      flies_(component.pin_count() == 0),
      newton_(coarse_.component, coarse_settings(settings)) {
  for (Index p = 0; p < coarse_.component.free_count; ++p) {
    coarse_masses_[coarse_.component.points[p]] = coarse_.component.masses[p];
  }
}

std::optional<int> TwoLevelNewton::solve(const Points& before, Points& positions, double steady_displacement) {
  gather(before, positions);
  coarse_x_ = coarse_target_;
  const auto iterations = newton_.solve(coarse_before_, coarse_x_, steady_displacement);
  if (!iterations) return iterations;
  note_tautness();
  interpolate_correction(steady_displacement);
  if (*iterations == 0 && rests()) {
    stay_still();
  } else if (flies_) {
    keep_momentum();
  }
  for (std::size_t n = 0; n < particles_.size(); ++n) positions.col(particles_[n]) = x_.col(static_cast<Index>(n));
  return iterations;
}

// Averages by mass, so that the fine level loses exactly the motion that the coarse level removes. With the coarse points' own
// particles instead, cloths in small steps gained energy.
void TwoLevelNewton::gather(const Points& before, const Points& positions) {
  const auto count = static_cast<Index>(particles_.size());
  const auto coarse_count = static_cast<Index>(coarse_.particles.size());
  coarse_before_.resize(Eigen::NoChange, coarse_count);
  for (Index q = 0; q < coarse_count; ++q) coarse_before_.col(q) = before.col(coarse_.particles[q]);
  before_.resize(Eigen::NoChange, count);
  target_.resize(Eigen::NoChange, count);
  coarse_target_ = coarse_before_;
  for (Index n = 0; n < count; ++n) {
    before_.col(n) = before.col(particles_[n]);
    target_.col(n) = positions.col(particles_[n]);
    const auto& [points, weights] = coarse_.interpolations[n];
    for (std::size_t k = 0; k < points.size(); ++k) {
      coarse_target_.col(points[k]) += weights[k] * masses_[n] / coarse_masses_[points[k]] * (target_.col(n) - before_.col(n));
    }
  }
  for (const Index q : coarse_.pins) coarse_target_.col(q) = positions.col(coarse_.particles[q]);
}

void TwoLevelNewton::note_tautness() {
  const std::vector<double> across = newton_.stiffness_across();
  const StretchComponent& component = coarse_.component;
  tautness_.assign(coarse_.particles.size(), 0.0);
  for (std::size_t s = 0; s < component.links.size(); ++s) {
    for (const Index end : {component.links[s].first, component.links[s].second}) tautness_[component.points[end]] += across[s];
  }
}

// Most fine links are half as long as coarse ones and carry half as much: their stiffness across is equal.
void TwoLevelNewton::interpolate_correction(double steady_displacement) {
  x_.resizeLike(target_);
  for (Index n = 0; n < static_cast<Index>(x_.cols()); ++n) {
    const auto& [points, weights] = coarse_.interpolations[n];
    Vector3 interpolated = Vector3::Zero();
    Vector3 target_move = Vector3::Zero();
    Vector3 solved_move = Vector3::Zero();
    double taut = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto at_begin = coarse_before_.col(points[k]);
      interpolated += weights[k] * at_begin;
      target_move += weights[k] * (coarse_target_.col(points[k]) - at_begin);
      solved_move += weights[k] * (coarse_x_.col(points[k]) - at_begin);
      taut += weights[k] * tautness_[points[k]];
    }
    const double slack = masses_[n] / (masses_[n] + taut);
    const Vector3 relative_move = target_.col(n) - before_.col(n) - target_move;
    const Vector3 straightening = (1.0 - slack) * (interpolated - before_.col(n));
    x_.col(n) =
        before_.col(n) + solved_move + slack * relative_move + shortened(straightening, kStraightenedOfFall * steady_displacement);
  }
}

Vector3 TwoLevelNewton::common_move() const {
  const Index free_point = coarse_.component.points.front();
  return coarse_x_.col(free_point) - coarse_before_.col(free_point);
}

/// The fine level rests when the coarse cloth rests: the motion relative to it is as small.
bool TwoLevelNewton::rests() const {
  double moved = 0.0;
  double inertia = 0.0;
  for (Index n = 0; n < static_cast<Index>(x_.cols()); ++n) {
    const Vector3 still = before_.col(n) + common_move();
    moved += masses_[n] * (x_.col(n) - still).squaredNorm();
    inertia += 0.5 * masses_[n] * (target_.col(n) - still).squaredNorm();
  }
  return moved <= kBalanced * inertia;
}

void TwoLevelNewton::stay_still() { x_ = before_.colwise() + common_move(); }

// Links push both ends equally on both levels; any other loss of momentum is distributed over all particles.
void TwoLevelNewton::keep_momentum() {
  Vector3 missing = Vector3::Zero();
  double mass = 0.0;
  for (Index n = 0; n < static_cast<Index>(x_.cols()); ++n) {
    missing += masses_[n] * (target_.col(n) - x_.col(n));
    mass += masses_[n];
  }
  x_.colwise() += missing / mass;
}

std::unique_ptr<ComponentSolver> make_component_solver(const SpringNetwork& network, StretchComponent component,
                                                       const StretchLimitSettings& settings, const LimitUse& use) {
  // Bodies that may collide are excluded: contact below the coarse level's resolution threw them up.
  const bool is_limp = !component.is_tree && !component.is_elastic && !use.may_collide;
  if (is_limp && component.free_count >= kLeastParticles) {
    if (auto coarse = coarsen(network, component, settings.kinds)) {
      return std::make_unique<TwoLevelNewton>(component, std::move(*coarse), settings);
    }
  }
  return std::make_unique<ComponentNewton>(std::move(component), settings);
}

}  // namespace sprung
