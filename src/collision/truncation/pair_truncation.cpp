#include "collision/truncation/pair_truncation.h"

#include "base/parallel.h"
#include "collision/core/feasible_point.h"

#include <algorithm>
#include <array>

namespace sprung {

namespace {

// Zones are made again around those that found no place, so often; then around all.
constexpr int kLocalRounds = 4;

constexpr Index kParticleChunk = 256;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

PairTruncation::PairTruncation(ObstacleSafeRegions& regions, PairSeparation& pairs, const std::vector<Index>& movable)
    : regions_(regions), pairs_(pairs), movable_(movable) {}

Outcomes PairTruncation::place(const Points& before, Points& after) {
  const Points allowed = after;
  Outcomes outcomes = place_held(before, after);
  if (count(outcomes, Outcome::infeasible) > 0) {
    const Way way{before, allowed};
    for (int round = 0; anchor_infeasible(outcomes, before, after); ++round) {
      if (round == 0) regions_.follow(way);
      regions_.renew_around(round < kLocalRounds ? without_place(outcomes) : movable_, way);
      place_among_obstacles(way, after);
      outcomes = place_held(before, after);
    }
    accept_carried(after, outcomes);
  }
  Outcomes all = of_movable(outcomes);
  look_at_misplaced(after, all);
  return all;
}

/// What obstacles alone left no place went along with one, which may have led it through another or through itself.
void PairTruncation::look_at_misplaced(const Points& after, Outcomes& outcomes) {
  if (misplaced_.empty()) return;
  regions_.renew_around(misplaced_, {after, after, true});
  for (std::size_t k = 0; k < movable_.size(); ++k) {
    if (std::binary_search(misplaced_.begin(), misplaced_.end(), movable_[k]) && regions_.is_crossed(movable_[k])) {
      outcomes[k] = Outcome::infeasible;
    }
  }
}

/// What is not held goes where it wants.
Outcomes PairTruncation::of_movable(const Outcomes& of_held) const {
  Outcomes outcomes(movable_.size(), Outcome::free);
  std::size_t n = 0;
  for (std::size_t k = 0; k < movable_.size() && n < held_.size(); ++k) {
    if (movable_[k] == held_[n]) outcomes[k] = of_held[n++];
  }
  return outcomes;
}

/// Zones before a surface that deforms lose what it goes otherwise than at their nearest points, which may be all of the room that
/// there is: of particles that went with the surface, only those are infeasible of whose elements it crosses one.
void PairTruncation::accept_carried(const Points& after, Outcomes& outcomes) {
  std::vector<Index> carried;
  for (const Index i : without_place(outcomes)) {
    const auto anchor = find_anchor(i);
    if (anchor != carriers_.anchors.end() && anchor->particle == i && anchor->surface) carried.push_back(i);
  }
  if (carried.empty()) return;
  regions_.renew_around(carried, {after, after, true});
  for (const Index i : carried) {
    const auto n = std::lower_bound(held_.begin(), held_.end(), i) - held_.begin();
    if (!regions_.is_crossed(i)) outcomes[static_cast<std::size_t>(n)] = Outcome::stopped;
  }
}

std::vector<KinematicAnchor>::iterator PairTruncation::find_anchor(Index particle) {
  std::vector<KinematicAnchor>& anchors = carriers_.anchors;
  return std::lower_bound(anchors.begin(), anchors.end(), particle,
                          [](const KinematicAnchor& a, Index b) { return a.particle < b; });
}

/// Zones that are new for their neighbours may not hold particles any more.
void PairTruncation::place_among_obstacles(const Way& way, Points& after) {
  after = way.to;
  std::vector<Index> last;
  std::vector<Index> without = infeasible(movable_, sprung::place(regions_, movable_, way, after));
  while (!without.empty() && without != last) {
    regions_.renew_around(without, way);
    last = std::move(without);
    without = infeasible(movable_, sprung::place(regions_, movable_, way, after));
  }
  misplaced_ = std::move(without);
}

std::vector<Index> PairTruncation::infeasible(const std::vector<Index>& particles, const Outcomes& outcomes) {
  std::vector<Index> found;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::infeasible) found.push_back(particles[n]);
  }
  return found;
}

std::vector<Index> PairTruncation::without_place(const Outcomes& outcomes) const {
  std::vector<Index> found = infeasible(held_, outcomes);
  std::erase_if(found, [&](Index i) { return pairs_.passes(i); });
  return found;
}

bool PairTruncation::anchor_infeasible(const Outcomes& outcomes, const Points& before, const Points& after) {
  bool changed = false;
  for (const Index i : without_place(outcomes)) {
    const KinematicAnchor anchor = regions_.anchor(i, before.col(i), after.col(i));
    const auto found = find_anchor(i);
    if (found == carriers_.anchors.end() || found->particle != i) {
      carriers_.anchors.insert(found, anchor);
    } else if (anchor.moves() && !found->moves()) {
      *found = anchor;
    } else {
      continue;
    }
    changed = true;
  }
  return changed;
}

Outcomes PairTruncation::place_held(const Points& before, Points& after) {
  const Points targets = after;
  carriers_.carried = regions_.carried(before);
  held_ = pairs_.hold(before, targets, carriers_);
  Outcomes outcomes(held_.size());
  parallel_chunks(static_cast<Index>(held_.size()), kParticleChunk, [&](Index begin, Index end) {
    for (Index n = begin; n < end; ++n) {
      const Index i = held_[at(n)];
      outcomes[at(n)] = place_held(i, before.col(i), targets.col(i), after);
    }
  });
  return outcomes;
}

Outcome PairTruncation::place_held(Index particle, const Vector3& before, const Vector3& target, Points& after) const {
  if (pairs_.passes(particle)) {
    after.col(particle) = pairs_.safe_place(particle);
    return Outcome::infeasible;
  }
  if (pairs_.allows(particle, target) && regions_.allow(particle, target)) return Outcome::free;
  std::vector<HalfSpace> bounds;
  regions_.append_half_spaces(particle, bounds);
  const std::size_t of_regions = bounds.size();
  pairs_.append_half_spaces(particle, bounds);
  const Vector3 apart = pairs_.safe_place(particle);
  const std::array<Vector3, 2> safe{apart, before};
  auto found = feasible_point(bounds, target, safe);
  if (found) {
    const auto [centre, radius] = pairs_.ball(particle);
    const double distance = (*found - centre).norm();
    if (distance > radius) *found = centre + radius / distance * (*found - centre);
  }
  if (found && pairs_.allows(particle, *found) && regions_.allow(particle, *found)) {
    after.col(particle) = *found;
    return Outcome::stopped;
  }
  after.col(particle) = apart;
  return is_feasible({bounds.data(), of_regions}, apart) ? Outcome::stopped : Outcome::infeasible;
}

}  // namespace sprung
