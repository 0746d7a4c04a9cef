#include "collision/truncation/vertex_truncation.h"

#include "base/parallel.h"
#include "collision/core/feasible_point.h"

#include <algorithm>

namespace sprung {

namespace {

// A place this near to where the particle was, as a part of its coordinates, is the same but for rounding.
constexpr double kRounding = 0x1p-46;

constexpr Index kParticleChunk = 256;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

Index count(const Outcomes& outcomes, Outcome wanted) {
  return static_cast<Index>(std::count(outcomes.begin(), outcomes.end(), wanted));
}

void keep_infeasible(const Outcomes& before, Outcomes& outcomes) {
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (before[n] == Outcome::infeasible) outcomes[n] = Outcome::infeasible;
  }
}

Outcome place(const ObstacleSafeRegions& regions, Index particle, const Way& way, Points& positions) {
  const Vector3 target = way.to.col(particle);
  if (regions.allow(particle, target)) {
    positions.col(particle) = target;
    return Outcome::free;
  }
  std::vector<HalfSpace> bounds;
  regions.append_half_spaces(particle, bounds);
  const Vector3 from = way.from.col(particle);
  std::vector<Vector3> safe;
  if (!way.obstacles_rest) regions.append_carried(particle, from, safe);
  safe.push_back(from);
  const auto found = feasible_point(bounds, target, safe);
  if (!found) {
    positions.col(particle) = safe.front();
    return Outcome::infeasible;
  }
  // A particle that cannot move stays to the last bit: what projections round would wear its height away, step by step.
  const bool stays = (*found - from).cwiseAbs().maxCoeff() <= kRounding * from.cwiseAbs().maxCoeff() && is_feasible(bounds, from);
  positions.col(particle) = stays ? from : *found;
  return Outcome::stopped;
}

Outcomes place(const ObstacleSafeRegions& regions, const std::vector<Index>& particles, const Way& way, Points& positions) {
  Outcomes outcomes(particles.size());
  parallel_chunks(static_cast<Index>(particles.size()), kParticleChunk, [&](Index begin, Index end) {
    for (Index n = begin; n < end; ++n) outcomes[at(n)] = place(regions, particles[at(n)], way, positions);
  });
  return outcomes;
}

}  // namespace sprung
