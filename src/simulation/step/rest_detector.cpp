#include "simulation/step/rest_detector.h"

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

}  // namespace

RestDetector::RestDetector(const SpringNetwork& network, double gravity)
    : network_(network), slow_(kFall * gravity), longest_(kRest * slow_) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_pinned(i)) free_.push_back(i);
  }
  for (const double length : network.springs.rest_length) {
    if (length > 0.0) longest_ = std::min(longest_, kOfSpring * length);
  }
}

bool RestDetector::rests(double time, SimulationState& state) const {
  const bool first = state.x_at_rest.cols() == 0;
  const bool moved = !first && has_moved(state);
  if (!first && !moved && time - state.rest_since < kRest) return false;
  const double drift = first ? 0.0 : mean_square(state.x - state.x_at_rest);
  const double speed_before = state.rest_speed2;
  state.x_at_rest = state.x;
  state.rest_since = time;
  state.rest_speed2 = mean_square(state.v);
  if (first || moved) return false;
  const double slow2 = slow_ * slow_;
  return drift <= kDrift * kDrift * longest_ * longest_ && state.rest_speed2 <= slow2 &&
         state.rest_speed2 <= std::max(speed_before, kNoise * kNoise * slow2);
}

bool RestDetector::all_touch(const std::vector<ContactNormal>& contacts) const {
  std::vector<char> touches(static_cast<std::size_t>(network_.particle_count()), 0);
  for (const ContactNormal& contact : contacts) touches[static_cast<std::size_t>(contact.particle)] = 1;
  return std::ranges::all_of(network_.bodies, [&](const Body& body) {
    bool is_free = false;
    for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      if (touches[static_cast<std::size_t>(i)] != 0) return true;
      is_free = is_free || !network_.is_pinned(i);
    }
    return !is_free;
  });
}

bool RestDetector::has_moved(const SimulationState& state) const {
  return std::ranges::any_of(
      free_, [&](Index i) { return !((state.x.col(i) - state.x_at_rest.col(i)).squaredNorm() <= longest_ * longest_); });
}

double RestDetector::mean_square(const Points& vectors) const {
  double sum = 0.0;
  for (const Index i : free_) sum += vectors.col(i).squaredNorm();
  return free_.empty() ? 0.0 : sum / static_cast<double>(free_.size());
}

}  // namespace sprung
