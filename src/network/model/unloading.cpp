#include "network/model/unloading.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>

namespace sprung {
namespace {

/// How long a spring waits for the front, in times that the wave takes to it. Fronts widen as they run. In a row of equal springs,
/// an eighth of the strain is left at this time, and up to a half with a loss factor of 0.1. It is two thirds when the wave
/// arrives.
constexpr double kFrontWait = 2.0;
/// How long a spring waits for the recoil, in the same times: four periods. A piece with a free and a held end swings once in four
/// times that a wave takes through it. With a loss factor of 0.1, half of the strain is left.
constexpr double kRecoilWait = 16.0;
/// The part of its break strain by which a spring exceeds it if another load than the recoil acts on it.
constexpr double kRecoilMargin = 0.5;
/// Breaks are beside a spring at a tear within this number of springs. The load that a break sheds in a sheet decays as 1 / r^2.
constexpr double kNearSprings = 4.0;

double wave_time_across(const SpringNetwork& network, Index s) {
  const Springs& springs = network.springs;
  const double inverse = 1.0 / network.masses[springs.first[s]] + 1.0 / network.masses[springs.second[s]];
  return std::sqrt(2.0 / (springs.stiffness[s] * inverse));
}

/// The springs at each particle.
class SpringsAt {
 public:
  explicit SpringsAt(const SpringNetwork& network)
      : begin_(static_cast<std::size_t>(network.particle_count()) + 1, 0),
        springs_(2 * static_cast<std::size_t>(network.springs.count())) {
    const Springs& springs = network.springs;
    const auto ends = {&springs.first, &springs.second};
    for (const std::vector<Index>* particles : ends) {
      for (const Index i : *particles) ++begin_[static_cast<std::size_t>(i) + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const std::vector<Index>* particles : ends) {
      for (Index s = 0; s < springs.count(); ++s) springs_[next[(*particles)[s]]++] = s;
    }
  }

  [[nodiscard]] std::span<const Index> of(Index i) const {
    return std::span(springs_).subspan(begin_[i], begin_[static_cast<std::size_t>(i) + 1] - begin_[i]);
  }

 private:
  std::vector<std::size_t> begin_;  ///< of each particle in `springs_`, and the end
  std::vector<Index> springs_;
};

/// The waves from springs of a network, by Dijkstra's algorithm.
class Waves {
 public:
  explicit Waves(const SpringNetwork& network) : network_(network), springs_at_(network) {}

  [[nodiscard]] std::vector<double> times_from(Index spring) const {
    std::vector<double> times(static_cast<std::size_t>(network_.particle_count()), std::numeric_limits<double>::infinity());
    using Arrival = std::pair<double, Index>;
    std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> queue;
    const auto reach = [&](Index i, double time) {
      if (time >= times[i]) return;
      times[i] = time;
      queue.emplace(time, i);
    };
    const Springs& springs = network_.springs;
    reach(springs.first[spring], 0.0);
    reach(springs.second[spring], 0.0);
    while (!queue.empty()) {
      const auto [time, i] = queue.top();
      queue.pop();
      if (time > times[i]) continue;
      for (const Index s : springs_at_.of(i)) {
        reach(springs.first[s] == i ? springs.second[s] : springs.first[s], time + wave_time_across(network_, s));
      }
    }
    return times;
  }

  /// The longest time across a structural spring at an end of this one [s]: the unit in which distances to it count springs.
  [[nodiscard]] double longest_time_across_at(Index spring) const {
    double longest = 0.0;
    for (const Index end : {network_.springs.first[spring], network_.springs.second[spring]}) {
      for (const Index s : springs_at_.of(end)) {
        const double across = wave_time_across(network_, s);
        if (network_.springs.kind[s] == SpringKind::structural && std::isfinite(across)) longest = std::max(longest, across);
      }
    }
    return longest;
  }

 private:
  const SpringNetwork& network_;
  SpringsAt springs_at_;
};

/// Lets the springs at all particles that the wave of a break at this time [s] reaches wait for it.
void add_break(const Waves& waves, Index broken, double time, std::vector<Unloading>& unloading) {
  const std::vector<double> times = waves.times_from(broken);
  const double across = waves.longest_time_across_at(broken);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) continue;
    Unloading& at = unloading[i];
    const double front = time + kFrontWait * times[i];
    at.by_all = std::max(at.by_all, front);
    at.by_recoil = std::max(at.by_recoil, time + kRecoilWait * times[i]);
    if (times[i] <= kNearSprings * across) at.by_near = std::max(at.by_near, front);
    if (times[i] <= across) at.is_at_tear = true;
  }
}

bool is_at_tear(const Unloading& a, const Unloading& b) { return a.is_at_tear || b.is_at_tear; }

bool awaits_front(const Springs& springs, Index s, double time, const std::vector<Unloading>& unloading) {
  const Unloading& a = unloading[springs.first[s]];
  const Unloading& b = unloading[springs.second[s]];
  return time < (is_at_tear(a, b) ? std::max(a.by_near, b.by_near) : std::max(a.by_all, b.by_all));
}

}  // namespace

std::vector<Index> springs_due(const SpringNetwork& network, const Points& positions, const Points& velocities, double time,
                               const std::vector<Unloading>& unloading) {
  const Springs& springs = network.springs;
  const auto waits = [&](Index s, const Vector3& along, double length) {
    if (unloading.empty()) return false;
    const Unloading& a = unloading[springs.first[s]];
    const Unloading& b = unloading[springs.second[s]];
    if (std::max(a.by_recoil, b.by_recoil) == 0.0) return false;  // no spring of its body broke
    if (awaits_front(springs, s, time, unloading)) return true;
    if ((velocities.col(springs.second[s]) - velocities.col(springs.first[s])).dot(along) < 0.0) return true;
    if (is_at_tear(a, b) || time >= std::max(a.by_recoil, b.by_recoil)) return false;
    const double longest = springs.laws[s].break_length;
    return length - longest < kRecoilMargin * (longest - springs.rest_length[s]);
  };
  std::vector<std::pair<double, Index>> due;  // the ratio of length to break length of a spring, and its number
  for (Index s = 0; s < static_cast<Index>(springs.laws.size()); ++s) {
    const double longest = springs.laws[s].break_length;
    const Vector3 along = positions.col(springs.second[s]) - positions.col(springs.first[s]);
    if (!(along.squaredNorm() > longest * longest)) continue;
    const double length = along.norm();
    if (!waits(s, along, length)) due.emplace_back(length / longest, s);
  }
  std::ranges::stable_sort(due, std::greater<>(), &std::pair<double, Index>::first);
  std::vector<Index> numbers(due.size());
  std::ranges::transform(due, numbers.begin(), &std::pair<double, Index>::second);
  return numbers;
}

std::vector<Index> breaking_springs(const SpringNetwork& network, const std::vector<Index>& due, double time,
                                    std::vector<Unloading>& unloading) {
  if (due.empty()) return {};
  unloading.resize(static_cast<std::size_t>(network.particle_count()));
  const Waves waves(network);
  std::vector<Index> breaking;
  for (const Index s : due) {
    if (!breaking.empty() && awaits_front(network.springs, s, time, unloading)) continue;
    breaking.push_back(s);
    add_break(waves, s, time, unloading);
  }
  std::ranges::sort(breaking);
  return breaking;
}

std::vector<double> wave_times(const SpringNetwork& network, Index spring) { return Waves(network).times_from(spring); }

}  // namespace sprung
