#include "simulation/sleep/rest_detector.h"

#include "dynamics/tethers/limited_springs.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// [s] of slow motion before sleep.
constexpr double kRest = 0.5;

// Gravity gives the fastest slow speed in this time [s].
constexpr double kFall = 1.0e-3;

// Largest displacement at rest, as a fraction of that of the fastest slow speed in a window, and of the shortest spring.
constexpr double kOfSlow = 0.4;
constexpr double kOfSpring = 0.1;

// Root mean square of the displacements at rest, as a fraction of the largest: what glides moves as a whole.
constexpr double kDrift = 0.25;

// Growth of the square of the speed from a window to the next that is noise. What begins to slide is twice as fast after the
// second window.
constexpr double kGrowth = 2.0;

// Smallest tolerance of the stretch limit: without one it is never reached exactly.
constexpr double kLeastTolerance = 1.0e-3;

// Speed that is noise, as a fraction of a slow speed.
constexpr double kNoise = 1.0e-3;

template <class Vector>
double mean_square(const std::vector<Index>& particles, const Vector& vector) {
  double sum = 0.0;
  for (const Index i : particles) sum += vector(i).squaredNorm();
  return particles.empty() ? 0.0 : sum / static_cast<double>(particles.size());
}

}  // namespace

RestDetector::RestDetector(const SpringNetwork& network, const SleepPatches& patches, const StretchLimit* limit, double gravity)
    : slow_(kFall * gravity) {
  std::vector<double> longest;  // by body
  for (const Body& body : network.bodies) {
    longest.push_back(kOfSlow * kRest * slow_);
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      const double length = network.springs.rest_length[s];
      if (length > 0.0) longest.back() = std::min(longest.back(), kOfSpring * length);
    }
  }
  for (const SleepPatch& patch : patches.patches) {
    Watched& watched = patches_.emplace_back(Watched{.body = patch.body, .free = {}, .longest = longest[patch.body]});
    std::ranges::copy_if(patch.particles, std::back_inserter(watched.free), [&](Index i) { return !network.is_pinned(i); });
  }
  if (limit == nullptr) return;
  const StretchLimitSettings& settings = limit->settings();
  const double longest_per_rest = 1.0 + settings.max_stretch + std::max(settings.tolerance, kLeastTolerance);
  for (const Index s : limited_springs(network, settings.kinds)) {
    const std::array<Index, 2> ends{network.springs.first[s], network.springs.second[s]};
    limited_.push_back({.ends = ends,
                        .body = patches.patches[patches.patch_of[ends[0]]].body,
                        .longest = longest_per_rest * network.springs.rest_length[s]});
  }
}

std::vector<char> RestDetector::restless(const SimulationState& state) const {
  std::vector<char> restless(patches_.size(), 0);
  if (!state.rest_since) return restless;
  std::vector<char> misses_limit(patches_.empty() ? 0 : patches_.back().body + 1, 0);  // by body
  for (const Limited& spring : limited_) {
    const double squared = (state.x.col(spring.ends[0]) - state.x.col(spring.ends[1])).squaredNorm();
    if (squared > spring.longest * spring.longest) misses_limit[spring.body] = 1;
  }
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const double allowed = patches_[p].longest - state.rests[p].crept;
    restless[p] = misses_limit[patches_[p].body] != 0 || displacement(patches_[p], state) > allowed ? 1 : 0;
  }
  return restless;
}

bool RestDetector::note(double time, const std::vector<char>& restless, const std::vector<char>& beside,
                        SimulationState& state) const {
  if (!state.rest_since) {
    state.rests.assign(patches_.size(), {});
    begin_window(time, state);
    return false;
  }
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    PatchRest& rest = state.rests[p];
    rest.is_unsettled = rest.is_unsettled || restless[p] != 0;
    rest.rests = rest.rests && restless[p] == 0;
  }
  if (time - *state.rest_since < kRest) return false;
  for (std::size_t p = 0; p < patches_.size(); ++p) end_window(patches_[p], beside[p] != 0, state, state.rests[p]);
  begin_window(time, state);
  return true;
}

void RestDetector::forget(SimulationState& state) {
  state.rest_since.reset();
  state.x_at_rest.resize(3, 0);
  state.rests.clear();
}

double RestDetector::displacement(const Watched& patch, const SimulationState& state) {
  double largest = 0.0;
  for (const Index i : patch.free) largest = std::max(largest, (state.x.col(i) - state.x_at_rest.col(i)).squaredNorm());
  return std::sqrt(largest);
}

void RestDetector::begin_window(double time, SimulationState& state) const {
  state.rest_since = time;
  state.x_at_rest = state.x;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    state.rests[p].speed2 = mean_square(patches_[p].free, [&](Index i) { return state.v.col(i); });
    state.rests[p].is_unsettled = false;
  }
}

void RestDetector::end_window(const Watched& patch, bool beside, const SimulationState& state, PatchRest& rest) const {
  const double drift = mean_square(patch.free, [&](Index i) { return state.x.col(i) - state.x_at_rest.col(i); });
  const double speed2 = mean_square(patch.free, [&](Index i) { return state.v.col(i); });
  rest.crept = beside ? rest.crept + displacement(patch, state) : 0.0;
  rest.rests = !rest.is_unsettled && drift <= kDrift * kDrift * patch.longest * patch.longest && speed2 <= slow_ * slow_ &&
               speed2 <= std::max(kGrowth * rest.speed2, kNoise * kNoise * slow_ * slow_);
}

}  // namespace sprung
