#include "dynamics/stretch_newton/component_newton.h"

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sprung {
namespace {

// Mostly a few suffice. A body that moves by many link lengths in a step needs about 200 for a chain of 2,000 particles and 45 for
// a strip. With a limit of 20 it stayed near the beginning of the step and fell a third as far as it should.
constexpr int kMostIterations = 200;
constexpr int kMostHalvings = 10;

// In a crumpled cloth without stretch and shear, each full step overshoots the limit of other links, so line searches shorten it.
// From this iteration on, links that ever overshot stay stiff. Earlier that would only slow convergence.
constexpr int kFreeIterations = 5;

// The fewest points of a tree that is solved coarsely first.
constexpr Index kLeastNested = 32;

// A coarse tree leaves out at least one in so many points; each with a branch of its own, none can be left out.
constexpr std::size_t kWorthLeaving = 4;

// A step that rotates links lengthens them, which the linear system does not know. Corrections continue while each removes half of
// the energy, and are kept if half of the forecast is gained.
constexpr int kMostCorrections = 5;
constexpr double kWorthwhile = 0.5;

// Iterations end when one lowered the energy as forecast, up to this fraction of the energy and the initial inertia term, and its
// solve left no more. The remaining gain is about that much, which needs no other solve to confirm. Chains need more iterations,
// which are cheap. Springs return the error that they store: a cloth of soft springs that hangs by its limit never comes to rest
// with 0.1, and gains energy as it swings with 0.01.
constexpr double kForecastOfChains = 1.0e-4;
constexpr double kForecastOfCloths = 0.1;
constexpr double kForecastOfElasticCloths = 1.0e-3;

// A heavy body that falls into a slack rope brings several times its weight, on few links. With a tenth of this, five crates on a
// rope exceeded its limit by 5.4 % instead of 4.3 %, and the pin's force still swung by 2.5 % instead of 1.5 % after 4 s.
constexpr double kLoadWithRods = 10.0;

// Heavy bodies hang on light ones, and the inertia term of a moving body is larger than that of its weight by the square of its
// speed over that which it gains in a step. With 1e-6 the recorded forces of a swinging hammock missed its weight by 2 %.
constexpr double kForecastWithRods = 1.0e-8;

// A corrected step sometimes matches its forecast by chance.
constexpr double kCorrectedFraction = 0.3;

// As kBalanced, for chains and trees, whose solves are exact and cheap: gravity restores this at an inclination of a ten thousandth
// of a degree. With kBalanced a rope of 20 m stopped for ever at a turning point 10 mm off the vertical.
constexpr double kBalancedChain = 1.0e-6 * kBalanced;

// A component with less relative deformation than this that took one iteration in the previous step hardly changes. For a moving
// one, an old factor, made with other slack links, would remove too much of the motion.
constexpr double kCalmDeformation = 1.0 / 240.0;

// Clipped links keep this fraction of the tolerance, so that rounding does not put them beyond the limit; without a tolerance the
// second constant applies.
constexpr double kClipFraction = 0.99;
constexpr double kClipRounding = 1.0 - 0x1p-36;

// Positions are equal if they differ by rounding alone; this fraction of the extent bounds it far from the origin too.
constexpr double kSamePosition = 0x1p-40;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

Index count_ties(const StretchComponent& component) {
  return static_cast<Index>(
      std::ranges::count_if(component.links, [&](const StretchComponent::Link& link) { return !component.is_free(link.second); }));
}

double balanced_fraction(const StretchComponent& component) {
  if (!component.rods.empty()) return 0.0;  // what a heavy body may neglect would stop a light one
  return component.is_tree ? kBalancedChain : kBalanced;
}

double close_enough(const StretchComponent& component) {
  if (!component.rods.empty()) return kForecastWithRods;
  if (component.is_tree) return kForecastOfChains;
  return component.is_elastic ? kForecastOfElasticCloths : kForecastOfCloths;
}

}  // namespace

ComponentNewton::ComponentNewton(StretchComponent component, const StretchLimitSettings& settings)
    : component_(std::move(component)),
      settings_(settings),
      energy_(component_, settings),
      clips_(component_.is_tree && count_ties(component_) == 1),
      mass_(std::accumulate(component_.masses.begin(), component_.masses.end(), 0.0)) {}
ComponentNewton::~ComponentNewton() = default;

std::optional<int> ComponentNewton::solve(const Points& before, Points& positions, double steady_displacement) {
  gather(before, positions);
  set_initial_iterate();
  if (is_at_rest()) {
    last_iterations_ = 0;
    write_to(positions);
    return 0;
  }
  energy_.set_load(1.0);
  const double beyond = energy_.value(target_, target_);
  if (beyond == 0.0) {
    balanced_energy_ = kUnknown;
    x_ = target_;
    return std::nullopt;
  }
  const double load = link_load(steady_displacement);
  energy_.set_load(load);
  energy_.find_near(target_);
  // Ordering takes time, and a component that is never solved needs none.
  if (!solver_) solver_ = make_system_solver(component_);
  // At the target of the forces the inertia term is zero: all energy is in links and proportional to the load.
  const int iterations = minimise(load * beyond, steady_displacement);
  last_iterations_ = iterations;
  if (clips_) clip();
  write_to(positions);
  return iterations;
}

void ComponentNewton::forget() {
  last_iterations_ = std::numeric_limits<int>::max();
  balanced_energy_ = kUnknown;
  farthest_squared_ = 0.0;
  if (solver_) solver_->forget();
}

void ComponentNewton::save(ByteWriter& to) const {
  to.write(last_iterations_);
  to.write(balanced_energy_);
  to.write(balanced_);
  to.write(balanced_target_);
  to.write(farthest_squared_);
  to.write(extent_);
  to.write(solver_ != nullptr);
  if (solver_) solver_->save(to);
}

void ComponentNewton::load(BinaryReader& from) {
  from.read(last_iterations_);
  from.read(balanced_energy_);
  from.read(balanced_);
  from.read(balanced_target_);
  from.read(farthest_squared_);
  from.read(extent_);
  const auto count = static_cast<Index>(component_.points.size());
  const bool rests = balanced_energy_ != kUnknown;
  if (rests && (balanced_.cols() != count || balanced_target_.cols() != count)) throw BytesError();
  bool has_solver = false;
  from.read(has_solver);
  if (!has_solver) return;
  if (!solver_) solver_ = make_system_solver(component_);
  solver_->load(from);
}

void ComponentNewton::set_rods(std::span<const RodRow> rows) {
  rows_ = rows;
  energy_.set_rods(rows);
}

void ComponentNewton::record(const ImpulseRecorder& recorder, std::vector<Vector3>& pushes) const {
  for (const StretchComponent::Rod& rod : component_.rods) {
    const Vector3 push = energy_.push(rod, x_);
    pushes[rod.number] += push;
    for (std::size_t k = 0; recorder.on() && k < rod.count; ++k) {
      if (component_.is_free(rod.points[k])) continue;
      recorder.add_to_pinned(component_.points[rod.points[k]], rows_[rod.number].weights[k] * push);
    }
  }
  if (!recorder.on()) return;
  const std::vector<double> pulls = energy_.pulls(x_);
  for (std::size_t s = 0; s < pulls.size(); ++s) {
    const StretchComponent::Link& link = component_.links[s];
    if (pulls[s] == 0.0) continue;
    recorder.add_to_spring(link.spring, pulls[s]);
    if (component_.is_free(link.second)) continue;
    recorder.add_to_pinned(component_.points[link.second], pulls[s] * (x_.col(link.first) - x_.col(link.second)).normalized());
  }
}

void ComponentNewton::write_to(Points& positions) const {
  for (Index i = 0; i < component_.free_count; ++i) positions.col(component_.points[i]) = x_.col(i);
}

void ComponentNewton::gather(const Points& before, const Points& positions) {
  const auto count = static_cast<Index>(component_.points.size());
  before_.resize(Eigen::NoChange, count);
  target_.resize(Eigen::NoChange, count);
  for (Index i = 0; i < count; ++i) {
    before_.col(i) = before.col(component_.points[i]);
    target_.col(i) = positions.col(component_.points[i]);
  }
  common_move_ = common_move();
  farthest_squared_ = ((target_ - before_).colwise() - common_move_).colwise().squaredNorm().maxCoeff();
  extent_ = bounds(before_).diagonal().norm();
}

/// The displacement of the pins, or of a free body, whose momentum is then right from the start.
Vector3 ComponentNewton::common_move() const {
  if (const Index pins = component_.pin_count(); pins > 0) return (target_ - before_).rightCols(pins).rowwise().mean();
  Vector3 moved = Vector3::Zero();
  for (Index i = 0; i < component_.free_count; ++i) moved += component_.masses[i] * (target_.col(i) - before_.col(i));
  return moved / mass_;
}

// The load follows from the acceleration. A particle that moves by u in a step on a circle of radius r has the centripetal
// acceleration u^2 / r; without one, the excess of links gives it. A link that is too stiff for a small step would take more from
// a swing than it stores: with a stiffness as large as the masses it stops the swing within a step.
double ComponentNewton::link_load(double steady_displacement) const {
  const double inwards = extent_ > 0.0 ? farthest_squared_ / extent_ : 0.0;
  const double displacement =
      std::max({steady_displacement, inwards, energy_.give(), steady_displacement + inwards > 0.0 ? 0.0 : most_beyond()});
  if (!component_.rods.empty()) return kLoadWithRods * component_.carried_mass * displacement;
  return mass_ / std::max(component_.pin_count(), Index{1}) * displacement;
}

double ComponentNewton::deformation() const { return extent_ > 0.0 ? std::sqrt(farthest_squared_) / extent_ : 0.0; }

double ComponentNewton::most_beyond() const {
  double most = 0.0;
  for (const StretchComponent::Link& link : component_.links) {
    const double length = (target_.col(link.first) - target_.col(link.second)).norm();
    most = std::max(most, length - (1.0 + settings_.max_stretch) * link.rest_length);
  }
  return most;
}

int ComponentNewton::minimise(double energy_at_target, double steady_displacement) {
  double energy = start(energy_at_target);
  const double at_first = inertia();
  const double negligible = balanced_fraction(component_) * at_first;
  // Masses alone overestimate the imbalance along links; an iteration may show that it is smaller.
  if (imbalance() <= negligible) {
    note_balance(energy);
    return 0;
  }
  // If contact moved a particle since, links store a different energy.
  if (target_shift() <= negligible && std::abs(energy - balanced_energy_) <= negligible) return 0;
  const bool is_calm = last_iterations_ <= 1 && deformation() <= kCalmDeformation;
  const double close = close_enough(component_);
  // Links near their limit will mostly reach it. If they were slack at first, each iteration would add only a few of them. With
  // rods most links that carry a load are beyond their limit at the beginning of the step, and others would only be in the way.
  double modelled = energy_.linearise(x_, target_, component_.rods.empty() ? NearLimit::pushing : NearLimit::slack, system_);
  bool is_too_stiff = false;
  energy_.forget_overshot();
  if (component_.is_tree && component_.free_count >= kLeastNested && leap(energy, steady_displacement)) modelled = energy;
  for (int iteration = 1; iteration <= kMostIterations; ++iteration) {
    system_.is_like_last = iteration == 1 && is_calm;
    system_.may_be_left = 0.5 * negligible;
    const double left = solver_->solve(system_, step_);
    const double forecast = modelled - 0.5 * system_.residual.cwiseProduct(step_).sum();
    const auto [fraction, corrected] = descend(energy, forecast);
    const bool is_balanced = iteration == 1 && 2.0 * std::max(modelled - forecast, left) <= negligible;
    balanced_energy_ = kUnknown;
    if (is_balanced) note_balance(energy);
    const double enough = (corrected ? kCorrectedFraction : 1.0) * close * (at_first + energy);
    if (fraction > 0.0 && !is_too_stiff && std::abs(energy - forecast) + left <= enough) return iteration;
    if (fraction == 0.0 && iteration > 1) return iteration;
    // The step was shortened by slack links, or pushing links made it worthless. A forecast with stiff links that do not pull
    // underestimates the gain.
    const bool restrains = iteration >= kFreeIterations && energy_.knows_overshot();
    is_too_stiff = fraction < 1.0 && !restrains;
    if (restrains) {
      energy_.linearise(x_, target_, NearLimit::overshot, system_);
    } else if (is_too_stiff) {
      energy_.linearise(x_, target_, NearLimit::stiff, system_);
    }
    modelled = energy;
  }
  return kMostIterations;
}

/// In motion, the beginning of the step is mostly nearer to the minimum than the target of the forces: there no spring is too
/// long.
void ComponentNewton::set_initial_iterate() {
  x_ = before_.colwise() + common_move_;
  x_.rightCols(component_.pin_count()) = target_.rightCols(component_.pin_count());
}

/// Linearises at the initial iterate if it is not the target; returns the energy there.
double ComponentNewton::start(double energy_at_target) {
  const double energy = energy_.linearise(x_, target_, NearLimit::slack, system_);
  if (energy <= energy_at_target) return energy;
  x_ = target_;
  return energy_.linearise(x_, target_, NearLimit::slack, system_);
}

void ComponentNewton::note_balance(double energy) {
  balanced_energy_ = energy;
  balanced_ = x_;
  balanced_target_ = target_;
}

/// Whether all points have moved by the same displacement since then, and the forces' target is nearly the same.
bool ComponentNewton::is_at_rest() const {
  if (balanced_energy_ == kUnknown) return false;
  const Vector3 common = x_.col(0) - balanced_.col(0);
  const double moved = ((x_ - balanced_).colwise() - common).cwiseAbs().maxCoeff();
  return moved <= kSamePosition * extent_ && target_shift() <= balanced_fraction(component_) * inertia();
}

/// Distance of the target from the one at rest, relative to the particles and weighted by mass. E is convex, so its minimum moves
/// no farther than that (Moreau 1965).
double ComponentNewton::target_shift() const {
  if (balanced_energy_ == kUnknown) return kUnknown;
  double sum = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) {
    sum += component_.masses[i] * ((target_.col(i) - x_.col(i)) - (balanced_target_.col(i) - balanced_.col(i))).squaredNorm();
  }
  return sum;
}

double ComponentNewton::inertia() const {
  double sum = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) sum += component_.masses[i] * (x_.col(i) - target_.col(i)).squaredNorm();
  return 0.5 * sum;
}

double ComponentNewton::imbalance() const {
  double sum = 0.0;
  for (Index i = 0; i < component_.free_count; ++i) sum += system_.residual.col(i).squaredNorm() / component_.masses[i];
  return sum;
}

// After a full step the system is linearised there; after a shortened one it is linearised anew.
ComponentNewton::Descent ComponentNewton::descend(double& energy, double forecast) {
  const auto go = [&](double reached) {
    energy = reached;
    x_.swap(tried_);
  };
  tried_ = x_;
  tried_.leftCols(component_.free_count) += step_;
  const double whole = energy_.linearise(tried_, target_, NearLimit::slack, tried_system_);
  if (whole < energy) {
    std::swap(system_, tried_system_);
    go(whole);
    return {.fraction = 1.0, .corrected = false};
  }
  if (correct(whole) < energy - kWorthwhile * (energy - forecast)) {
    go(energy_.linearise(tried_, target_, NearLimit::slack, system_));
    return {.fraction = 1.0, .corrected = true};
  }
  tried_.leftCols(component_.free_count) = x_.leftCols(component_.free_count) + step_;
  energy_.note_overshot(tried_);
  double fraction = 0.5;
  for (int halving = 1; halving <= kMostHalvings; ++halving, fraction *= 0.5) {
    tried_ = x_;
    tried_.leftCols(component_.free_count) += fraction * step_;
    if (const double reached = energy_.value(tried_, target_); reached < energy) {
      go(reached);
      return {.fraction = fraction, .corrected = false};
    }
  }
  return {.fraction = 0.0, .corrected = false};
}

/// Corrects the trial step for the links that it rotated; returns the energy there.
double ComponentNewton::correct(double reached) {
  for (int correction = 0; correction < kMostCorrections; ++correction) {
    energy_.take_turning(x_, tried_, system_);
    solver_->solve_again(system_, correction_);
    corrected_ = tried_;
    corrected_.leftCols(component_.free_count) += correction_;
    const double next = energy_.value(corrected_, target_);
    const bool goes_on = next < kWorthwhile * reached;
    if (next < reached) {
      reached = next;
      tried_.swap(corrected_);
    }
    if (!goes_on) break;
  }
  return reached;
}

/// Goes to the minimum of the coarse tree and linearises there, if the energy is lower. Returns whether it is.
bool ComponentNewton::leap(double& energy, double steady_displacement) {
  if (!coarse_) {
    coarse_ = std::make_unique<CoarseTree>(coarsen(component_));
    on_coarse_ = std::make_unique<ComponentNewton>(coarse_->component, settings_);
  }
  if (coarse_->between.size() * kWorthLeaving < component_.points.size()) return false;
  on_coarse_->forget();
  tried_ = target_;
  on_coarse_->solve(before_, tried_, steady_displacement);
  coarse_->place_others(target_, settings_.max_stretch, tried_);
  if (energy_.value(tried_, target_) >= energy) return false;
  x_.swap(tried_);
  energy = energy_.linearise(x_, target_, NearLimit::slack, system_);
  return true;
}

void ComponentNewton::clip() {
  const double most = (1.0 + settings_.max_stretch + kClipFraction * settings_.tolerance) * kClipRounding;
  for (Index i = component_.free_count - 1; i >= 0; --i) {
    for (Index k = component_.begin[i]; k < component_.begin[i + 1]; ++k) {
      const StretchComponent::Link& link = component_.links[k];
      const Vector3 between = x_.col(i) - x_.col(link.second);
      const double longest = most * link.rest_length;
      if (between.squaredNorm() > longest * longest) x_.col(i) = x_.col(link.second) + longest / between.norm() * between;
    }
  }
}

}  // namespace sprung
