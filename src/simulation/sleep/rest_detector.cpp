#include "simulation/sleep/rest_detector.h"

#include "simulation/sleep/islands.h"

#include <algorithm>

namespace sprung {
namespace {

// [s] of slow motion before sleep.
constexpr double kRest = 0.5;

// Gravity gives the fastest slow speed in this time [s].
constexpr double kFall = 1.0e-3;

// Displacement at rest, as a fraction of the shortest spring.
constexpr double kOfSpring = 0.25;

// Root mean square of the displacements at rest, as a fraction of the largest: a body that glides moves as a whole.
constexpr double kDrift = 0.1;

// Speed that is noise, as a fraction of a slow speed.
constexpr double kNoise = 1.0e-3;

template <class Vector>
double mean_square(const std::vector<Index>& particles, const Vector& vector) {
  double sum = 0.0;
  for (const Index i : particles) sum += vector(i).squaredNorm();
  return particles.empty() ? 0.0 : sum / static_cast<double>(particles.size());
}

}  // namespace

RestDetector::RestDetector(const SpringNetwork& network, double gravity) : slow_(kFall * gravity) {
  for (const Body& body : network.bodies) {
    Watched& watched = bodies_.emplace_back(Watched{.free = {}, .longest = kRest * slow_});
    for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      if (!network.is_pinned(i)) watched.free.push_back(i);
    }
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      const double length = network.springs.rest_length[s];
      if (length > 0.0) watched.longest = std::min(watched.longest, kOfSpring * length);
    }
  }
}

void RestDetector::note(double time, const std::vector<char>& driven, const std::vector<Index>& islands,
                        SimulationState& state) const {
  if (state.x_at_rest.cols() == 0) {
    state.x_at_rest = state.x;
    state.rests.assign(bodies_.size(), {});
  }
  std::vector<char> restless = driven;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!state.rests[b].since || has_moved(bodies_[b], state)) restless[b] = 1;
  }
  restless = with_islands(restless, islands);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodyRest& rest = state.rests[b];
    if (restless[b] != 0) {
      rest.rests = false;
      begin_window(bodies_[b], time, state, rest);
    } else if (time - *rest.since >= kRest) {
      end_window(bodies_[b], time, state, rest);
    }
  }
}

bool RestDetector::has_moved(const Watched& body, const SimulationState& state) {
  return std::ranges::any_of(body.free, [&](Index i) {
    return !((state.x.col(i) - state.x_at_rest.col(i)).squaredNorm() <= body.longest * body.longest);
  });
}

void RestDetector::begin_window(const Watched& body, double time, SimulationState& state, BodyRest& rest) const {
  rest.since = time;
  rest.speed2 = mean_square(body.free, [&](Index i) { return state.v.col(i); });
  for (const Index i : body.free) state.x_at_rest.col(i) = state.x.col(i);
}

void RestDetector::end_window(const Watched& body, double time, SimulationState& state, BodyRest& rest) const {
  const double drift = mean_square(body.free, [&](Index i) { return state.x.col(i) - state.x_at_rest.col(i); });
  const double speed2_before = rest.speed2;
  begin_window(body, time, state, rest);
  rest.rests = drift <= kDrift * kDrift * body.longest * body.longest && rest.speed2 <= slow_ * slow_ &&
               rest.speed2 <= std::max(speed2_before, kNoise * kNoise * slow_ * slow_);
}

}  // namespace sprung
