#include "simulation/monitoring/divergence.h"

#include "base/format.h"
#include "base/machine/finite.h"
#include "base/parallel.h"
#include "network/model/activity.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace sprung {
namespace {

constexpr double kOverstretched = 1000.0;

constexpr Index kParticleChunk = 8192;

bool is_finite(const SimulationState& state) {
  std::atomic<bool> finite = true;
  parallel_chunks(static_cast<Index>(state.x.cols()), kParticleChunk, [&](Index begin, Index end) {
    const Index count = 3 * (end - begin);
    if (!are_finite(state.x.col(begin).data(), count) || !are_finite(state.v.col(begin).data(), count)) finite = false;
  });
  return finite;
}

/// The longest rest length [m] of the springs of its body, for each spring.
std::vector<double> longest_of_bodies(const SpringNetwork& network) {
  const std::vector<double>& rest = network.springs.rest_length;
  std::vector<double> longest(rest.size(), 0.0);
  for (const Body& body : network.bodies) {
    if (body.spring_count == 0) continue;
    const auto begin = rest.begin() + body.first_spring;
    std::fill_n(longest.begin() + body.first_spring, body.spring_count, *std::max_element(begin, begin + body.spring_count));
  }
  return longest;
}

double length(const Points& positions, Index a, Index b) { return (positions.col(a) - positions.col(b)).norm(); }

/// `3 m long, 1 m at rest: stretched by 200 %, pulling with 20 N`
std::string state_of_spring(const Springs& springs, std::size_t spring, double length) {
  const double rest = springs.rest_length[spring];
  const double stretch = length - rest;
  const std::string percent = rest > 0.0 ? " by " + format_number(100.0 * std::abs(stretch) / rest, 3) + " %" : "";
  return format_number(length, 3) + " m long, " + format_number(rest, 3) +
         " m at rest: " + (stretch < 0.0 ? "compressed" : "stretched") + percent +
         (stretch < 0.0 ? ", pushing with " : ", pulling with ") + format_number(springs.stiffness[spring] * std::abs(stretch), 3) +
         " N";
}

}  // namespace

DivergenceCheck::DivergenceCheck(const SpringNetwork& network) : network_(network) {
  const Springs& springs = network.springs;
  double longest_rest = 0.0;  // reference length for springs of length 0
  for (const double rest : springs.rest_length) longest_rest = std::max(longest_rest, rest);
  const std::vector<double> of_bodies = longest_of_bodies(network);
  longest_squared_.reserve(static_cast<std::size_t>(springs.count()));
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    const double start = std::max(springs.rest_length[s], length(network.positions, springs.first[s], springs.second[s]));
    const double longest = std::max(of_bodies[s], kOverstretched * (start > 0.0 ? start : longest_rest));
    const bool pulls = springs.stiffness[s] > 0.0;  // a spring without stiffness has no bound
    longest_squared_.push_back(pulls && longest > 0.0 ? longest * longest : HUGE_VAL);
    if (longest_squared_.back() < HUGE_VAL) bounded_.push_back(static_cast<Index>(s));
  }
}

std::optional<StepFailure> DivergenceCheck::not_finite(const SimulationState& state, const Points& before) const {
  if (is_finite(state)) return std::nullopt;
  Index particle = 0;
  while (state.x.col(particle).allFinite() && state.v.col(particle).allFinite()) ++particle;
  StepFailure failure = blame(particle, worst_spring_at(particle, before), before);
  failure.cause = "a position or velocity is not finite" + (failure.cause.empty() ? "" : "; one step before, " + failure.cause);
  return failure;
}

std::optional<StepFailure> DivergenceCheck::overstretched(const Points& positions) const {
  const Springs& springs = network_.springs;
  Index worst = kNone;
  double most = 1.0;
  for (const Index s : bounded_) {
    const double ratio = squared_ratio(s, positions);
    if (ratio <= most) continue;
    most = ratio;
    worst = s;
  }
  if (worst == kNone) return std::nullopt;
  const Index a = springs.first[static_cast<std::size_t>(worst)];
  const Index b = springs.second[static_cast<std::size_t>(worst)];
  StepFailure failure = blame(network_.is_fixed(a) ? b : a, worst, positions);
  failure.remedy = has_moving_pin(network_.pins) ? "use more stiffness, a \"stretch_limit\" or slower pins"
                                                 : "use more stiffness or a \"stretch_limit\"";
  return failure;
}

StepFailure DivergenceCheck::fastest(const SimulationState& state) const {
  Index particle = 0;
  state.v.colwise().squaredNorm().maxCoeff(&particle);
  return blame(particle, worst_spring_at(particle, state.x), state.x);
}

double DivergenceCheck::squared_ratio(Index spring, const Points& positions) const {
  const Springs& springs = network_.springs;
  const double yielded = kOverstretched * springs.rest_length[spring];
  return (positions.col(springs.first[spring]) - positions.col(springs.second[spring])).squaredNorm() /
         std::max(longest_squared_[spring], yielded * yielded);
}

StepFailure DivergenceCheck::blame(Index particle, Index spring, const Points& positions) const {
  const Body& body = network_.body_of(particle);
  StepFailure failure;
  failure.body = body.name;
  failure.particle = particle - body.first_particle;
  if (spring == kNone) return failure;
  const auto s = static_cast<std::size_t>(spring);
  const Index a = network_.springs.first[s];
  const Index b = network_.springs.second[s];
  failure.spring = spring - body.first_spring;
  failure.cause = "the spring between particles " + std::to_string(a - body.first_particle) + " and " +
                  std::to_string(b - body.first_particle) + " was " + state_of_spring(network_.springs, s, length(positions, a, b));
  return failure;
}

Index DivergenceCheck::worst_spring_at(Index particle, const Points& positions) const {
  const Springs& springs = network_.springs;
  Index worst = kNone;
  double most = -1.0;
  for (Index s = 0; s < springs.count(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    if (springs.first[i] != particle && springs.second[i] != particle) continue;
    const double ratio = squared_ratio(s, positions);
    if (worst != kNone && !(ratio > most)) continue;
    most = ratio;
    worst = s;
  }
  return worst;
}

}  // namespace sprung
