#include "collision/truncation/vertex_truncation.h"

#include "base/parallel.h"
#include "collision/core/half_space.h"

#include <algorithm>

namespace sprung {
namespace {

// A displacement smaller than this fraction of the coordinates is rounding.
constexpr double kRounding = 0x1p-46;

constexpr Index kParticleChunk = 256;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

// A particle that an obstacle stops at its present position keeps it bit for bit. Otherwise the rounding of the projections would
// reduce its height in every step.
Vector3 without_rounding(const std::vector<HalfSpace>& bounds, const Vector3& from, const Vector3& position) {
  const bool stays = (position - from).cwiseAbs().maxCoeff() <= kRounding * from.cwiseAbs().maxCoeff() && is_feasible(bounds, from);
  return stays ? from : position;
}

constexpr double kMinFraction = 1.0 / 64.0;

}  // namespace

Index count(const Outcomes& outcomes, Outcome wanted) {
  return static_cast<Index>(std::count(outcomes.begin(), outcomes.end(), wanted));
}

std::vector<Index> particles_with(Outcome wanted, const std::vector<Index>& particles, const Outcomes& outcomes) {
  std::vector<Index> found;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == wanted) found.push_back(particles[n]);
  }
  return found;
}

void keep_infeasible(const Outcomes& before, Outcomes& outcomes) {
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (before[n] == Outcome::infeasible) outcomes[n] = Outcome::infeasible;
  }
}

VertexTruncation::VertexTruncation(const ObstacleSafeRegions& regions, const PairSeparation* pairs)
    : regions_(regions), pairs_(pairs) {}

Outcomes VertexTruncation::clip(const std::vector<Index>& particles, const StepPaths& paths, Points& positions) const {
  Outcomes outcomes(particles.size());
  parallel_chunks(static_cast<Index>(particles.size()), kParticleChunk, [&](Index begin, Index end) {
    for (Index n = begin; n < end; ++n) outcomes[at(n)] = clip(particles[at(n)], paths, positions);
  });
  return outcomes;
}

Outcome VertexTruncation::clip(Index particle, const StepPaths& paths, Points& positions) const {
  const Vector3 target = paths.to.col(particle);
  auto&& position = positions.col(particle);
  if (pairs_ != nullptr && pairs_->crosses(particle)) {
    position = pairs_->safe_position(particle);
    return Outcome::infeasible;
  }
  if (allows(paths.obstacles, particle, target)) {
    position = target;
    return Outcome::free;
  }
  std::vector<HalfSpace> bounds;
  regions_.append_half_spaces(paths.obstacles, particle, bounds);
  const std::size_t region_bounds = bounds.size();
  if (pairs_ != nullptr) pairs_->append_half_spaces(particle, bounds);
  const std::vector<Vector3> safe = safe_positions(particle, paths);
  if (const auto found = feasible_point(bounds, target, safe)) {
    if (pairs_ == nullptr) {
      position = without_rounding(bounds, paths.from.col(particle), *found);
      return Outcome::stopped;
    }
    // The sphere is not among the half-spaces: the shortened displacement may violate them.
    const Vector3 shortened = within_sphere(particle, *found);
    if (allows(paths.obstacles, particle, shortened)) {
      position = shortened;
      return Outcome::stopped;
    }
  }
  position = safe.front();
  return is_feasible({bounds.data(), region_bounds}, safe.front()) ? Outcome::stopped : Outcome::infeasible;
}

bool VertexTruncation::allows(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const {
  return (pairs_ == nullptr || pairs_->allows(particle, position)) && regions_.allow(obstacles, particle, position);
}

std::vector<Vector3> VertexTruncation::safe_positions(Index particle, const StepPaths& paths) const {
  std::vector<Vector3> safe;
  if (pairs_ != nullptr) {
    safe.push_back(pairs_->safe_position(particle));
  } else if (!paths.at_end) {
    ObstacleMotion(regions_, paths.obstacles).append_moved(particle, paths.from.col(particle), safe);
  }
  safe.emplace_back(paths.from.col(particle));
  return safe;
}

Vector3 VertexTruncation::within_sphere(Index particle, const Vector3& position) const {
  const auto [center, radius] = pairs_->sphere(particle);
  const double distance = (position - center).norm();
  return distance > radius ? Vector3(center + radius / distance * (position - center)) : position;
}

// The loop ends: each round either halves the substep, at most six times, or finishes at least 1/64 of the interval.
Outcomes clip_in_substeps(const StepPaths& paths, Points& after, const ClipSubstep& clip) {
  const double begin = paths.obstacles.begin();
  const double end = paths.obstacles.end();
  const auto time = [&](double fraction) { return fraction < 1.0 ? begin + fraction * (end - begin) : end; };
  Outcomes outcomes;
  Points from = paths.from;
  double done = 0.0;
  double fraction = 0.5;
  while (done < 1.0) {
    const double next = std::min(1.0, done + fraction);
    const ObstacleFrame obstacles = paths.obstacles.part(time(done), time(next));
    const Points to = next < 1.0 ? Points(from + (next - done) / (1.0 - done) * (paths.to - from)) : paths.to;
    after = to;
    auto [of_substep, path_checked] = clip({obstacles, from, to}, after);
    if (fraction > kMinFraction && (!path_checked || count(of_substep, Outcome::infeasible) > 0)) {
      fraction *= 0.5;
      continue;
    }
    keep_infeasible(outcomes, of_substep);
    outcomes = std::move(of_substep);
    from = after;
    done = next;
  }
  return outcomes;
}

}  // namespace sprung
