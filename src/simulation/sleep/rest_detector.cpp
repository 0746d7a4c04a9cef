#include "simulation/sleep/rest_detector.h"

#include "dynamics/tethers/limited_springs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace sprung {
namespace {

// Time between two comparisons [s].
constexpr double kWindow = 0.25;

// Gravity gives the fastest slow speed in this time [s].
constexpr double kFall = 1.0e-3;

// Largest displacement at rest, as a fraction of the shortest spring. A slow speed gives another bound.
constexpr double kOfSpring = 0.1;

// Change of the springs' force on a group that does not wake it, as a fraction of its weight.
constexpr double kOfWeight = 0.1;

// Root mean square of the displacements in a quiet window, as a fraction of the largest: what glides moves as a whole.
constexpr double kQuiet = 0.125;

// Growth of these displacements from a window to the next at rest. What begins to slide moves three times as far in the second
// window.
constexpr double kGrowth = 2.0;

// Displacements that are noise, as a fraction of those in a quiet window.
constexpr double kNoise = 0.08;

}  // namespace

RestDetector::RestDetector(const SpringNetwork& network, const SleepGroups& groups, const StretchLimit* limit,
                           const Vector3& gravity)
    : gravity_(gravity), masses_(groups.groups.size(), 0.0) {
  for (Index i = 0; i < network.particle_count(); ++i) masses_[groups.group_of[i]] += network.masses[i];
  watch(network, groups);
  find_pulling(network, groups.group_of);
  if (limit != nullptr) find_limited(network, limit->settings());
}

void RestDetector::watch(const SpringNetwork& network, const SleepGroups& groups) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    double longest = std::numeric_limits<double>::infinity();
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      const double length = network.springs.rest_length[s];
      if (length > 0.0) longest = std::min(longest, kOfSpring * length);
    }
    bodies_.push_back({.body = b, .free = {}, .longest = longest});
  }
  for (const SleepGroup& group : groups.groups) {
    Watched& body = bodies_[group.body];
    Watched& watched = groups_.emplace_back(Watched{.body = group.body, .free = {}, .longest = body.longest});
    std::ranges::copy_if(group.particles, std::back_inserter(watched.free), [&](Index i) { return !network.is_fixed(i); });
    body.free.insert(body.free.end(), watched.free.begin(), watched.free.end());
  }
}

void RestDetector::find_pulling(const SpringNetwork& network, const std::vector<Index>& group_of) {
  const Springs& springs = network.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    Index awake = springs.first[s];
    Index asleep = springs.second[s];
    if (network.is_asleep(awake)) std::swap(awake, asleep);
    if (network.is_asleep(awake) || !network.is_asleep(asleep) || springs.stiffness[s] == 0.0) continue;
    pulling_.push_back({.awake = awake,
                        .asleep = asleep,
                        .awake_group = group_of[awake],
                        .asleep_group = group_of[asleep],
                        .stiffness = springs.stiffness[s]});
  }
}

void RestDetector::find_limited(const SpringNetwork& network, const StretchLimitSettings& settings) {
  const double longest = 1.0 + settings.max_stretch + wanted_excess(settings);  // relative to the rest length
  for (const Index s : limited_springs(network, settings.kinds)) {
    const Index first = network.springs.first[s];
    const auto body = static_cast<std::size_t>(&network.body_of(first) - network.bodies.data());
    limited_.push_back(
        {.ends = {first, network.springs.second[s]}, .body = body, .longest = longest * network.springs.rest_length[s]});
  }
}

std::vector<char> RestDetector::restless(const SimulationState& state) const {
  std::vector<char> restless(groups_.size(), 0);
  if (!state.rest.window_begin) return restless;
  std::vector<char> misses_limit(bodies_.size(), 0);
  for (const Limited& spring : limited_) {
    const double squared = (state.x.col(spring.ends[0]) - state.x.col(spring.ends[1])).squaredNorm();
    if (squared > spring.longest * spring.longest) misses_limit[spring.body] = 1;
  }
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    restless[p] = misses_limit[groups_[p].body] != 0 || has_moved(groups_[p], state) ? 1 : 0;
  }
  const std::vector<Vector3> pulls = changes_of_pull(state);
  for (const Pulling& spring : pulling_) {
    if (pulls[spring.asleep_group].norm() > kOfWeight * gravity_.norm() * masses_[spring.asleep_group])
      restless[spring.awake_group] = 1;
  }
  return restless;
}

/// The change of the springs' force on each group that sleeps, since it fell asleep [N].
std::vector<Vector3> RestDetector::changes_of_pull(const SimulationState& state) const {
  std::vector<Vector3> changes(groups_.size(), Vector3::Zero());
  for (const Pulling& spring : pulling_) {
    const Vector3 now = state.x.col(spring.awake) - state.x.col(spring.asleep);
    const Vector3 then = state.rest.x_beside_sleep.col(spring.awake) - state.x.col(spring.asleep);
    if (now.norm() == 0.0) continue;
    changes[spring.asleep_group] += spring.stiffness * (now.norm() - then.norm()) * now.normalized();
  }
  return changes;
}

bool RestDetector::window_ends(double time, const SimulationState& state) {
  return !state.rest.window_begin || time - *state.rest.window_begin >= kWindow;
}

void RestDetector::end_window(double time, const std::vector<char>& restless, const std::vector<char>& beside,
                              SimulationState& state) const {
  if (!state.rest.window_begin) {
    state.rest.histories.assign(groups_.size() + bodies_.size(), {});
    state.rest.x_beside_sleep = state.x;
  } else {
    judge_all(restless, state);
  }
  state.rest.window_begin = time;
  state.rest.x_at_begin = state.x;
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    if (beside[p] != 0) continue;
    for (const Index i : groups_[p].free) state.rest.x_beside_sleep.col(i) = state.x.col(i);
  }
}

void RestDetector::forget(SimulationState& state) {
  state.rest.window_begin.reset();
  state.rest.x_at_begin.resize(3, 0);
  state.rest.x_beside_sleep.resize(3, 0);
  state.rest.histories.clear();
}

double RestDetector::slow() const { return kFall * gravity_.norm(); }

double RestDetector::longest(const Watched& group) const { return std::min(kWindow * slow(), group.longest); }

bool RestDetector::has_moved(const Watched& group, const SimulationState& state) const {
  const double longest = this->longest(group);
  return std::ranges::any_of(
      group.free, [&](Index i) { return (state.x.col(i) - state.rest.x_beside_sleep.col(i)).squaredNorm() > longest * longest; });
}

void RestDetector::judge_all(const std::vector<char>& restless, SimulationState& state) const {
  std::vector<char> of_bodies(bodies_.size(), 0);
  const auto rest_of_body = [&](std::size_t body) -> MotionHistory& { return state.rest.histories[groups_.size() + body]; };
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    const std::size_t body = groups_[p].body;
    of_bodies[body] = of_bodies[body] != 0 || restless[p] != 0 ? 1 : 0;
    judge(groups_[p], restless[p] != 0, state, state.rest.histories[p]);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) judge(bodies_[b], of_bodies[b] != 0, state, rest_of_body(b));
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    state.rest.histories[p].is_at_rest = state.rest.histories[p].is_at_rest || rest_of_body(groups_[p].body).is_at_rest;
  }
}

void RestDetector::judge(const Watched& group, bool is_restless, const SimulationState& state, MotionHistory& rest) const {
  const auto root_mean_square = [&](const auto& vector) {
    double sum = 0.0;
    for (const Index i : group.free) sum += vector(i).squaredNorm();
    return group.free.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(group.free.size()));
  };
  const double speed = root_mean_square([&](Index i) { return state.v.col(i); });
  const double displacement = root_mean_square([&](Index i) { return state.x.col(i) - state.rest.x_at_begin.col(i); });
  const double largest = kQuiet * longest(group);
  const bool is_quiet = !is_restless && speed <= slow() && displacement <= largest;
  const bool grows = displacement > kGrowth * std::max(rest.displacement, kNoise * largest);
  rest = {.displacement = displacement, .was_quiet = is_quiet, .is_at_rest = is_quiet && rest.was_quiet && !grows};
}

}  // namespace sprung
