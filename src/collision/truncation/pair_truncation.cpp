#include "collision/truncation/pair_truncation.h"

#include <algorithm>
#include <utility>

namespace sprung {

namespace {

// In the first rounds regions are renewed around infeasible particles, which is cheap; then around all.
constexpr int kLocalRounds = 4;

// Rounds of renewed regions before obstacles. They end when the set of infeasible particles stops changing; the bound is there
// because two sets could alternate.
constexpr int kMaxRenewals = 32;

}  // namespace

PairTruncation::PairTruncation(const ObstacleFrame& obstacles, ObstacleSafeRegions& regions, PairSeparation& pairs,
                               const std::vector<Index>& movable)
    : obstacles_(obstacles), regions_(regions), pairs_(pairs), movable_(movable) {}

// The loop ends: each round adds at least one blocked vertex, or makes a resting one move, and neither is undone.
Outcomes PairTruncation::clip(const Points& before, Points& after) {
  const Points allowed = after;
  Outcomes outcomes = clip_constrained(before, after);
  if (count(outcomes, Outcome::infeasible) > 0) {
    const StepPaths paths{obstacles_, before, allowed};
    for (int round = 0; block_infeasible(outcomes, before, after); ++round) {
      if (round == 0) regions_.update(paths);
      regions_.renew_around(round < kLocalRounds ? blocked_by_obstacles(outcomes) : movable_, paths);
      clip_before_obstacles(paths, after);
      outcomes = clip_constrained(before, after);
    }
    accept_moved(after, outcomes);
  }
  Outcomes all = of_movable(outcomes);
  check_unplaced(after, all);
  return all;
}

Outcomes PairTruncation::clip_constrained(const Points& before, Points& after) {
  const Points targets = after;
  displacements_.moved = ObstacleMotion(regions_, obstacles_).displacements(before);
  constrained_ = pairs_.constrain(before, targets, displacements_);
  return VertexTruncation(regions_, &pairs_).clip(constrained_, {obstacles_, before, targets}, after);
}

// Regions that are renewed around infeasible particles may exclude their neighbours, which are then renewed too.
void PairTruncation::clip_before_obstacles(const StepPaths& paths, Points& after) {
  after = paths.to;
  const VertexTruncation truncation(regions_);
  unplaced_ = particles_with(Outcome::infeasible, movable_, truncation.clip(movable_, paths, after));
  for (int round = 0; round < kMaxRenewals && !unplaced_.empty(); ++round) {
    regions_.renew_around(unplaced_, paths);
    const std::vector<Index> last =
        std::exchange(unplaced_, particles_with(Outcome::infeasible, movable_, truncation.clip(movable_, paths, after)));
    if (unplaced_ == last) break;
  }
}

bool PairTruncation::block_infeasible(const Outcomes& outcomes, const Points& before, const Points& after) {
  bool changed = false;
  for (const Index i : blocked_by_obstacles(outcomes)) {
    const BlockedVertex vertex = ObstacleMotion(regions_, obstacles_).blocked_vertex(i, before.col(i), after.col(i));
    const auto found = find_blocked(i);
    if (found == displacements_.blocked.end() || found->particle != i) {
      displacements_.blocked.insert(found, vertex);
    } else if (vertex.moves() && !found->moves()) {
      *found = vertex;
    } else {
      continue;
    }
    changed = true;
  }
  return changed;
}

// Before a deforming surface a region shrinks by all motion that differs from the motion of the closest points. That may leave no
// room. So a particle that moved with the surface is infeasible only if the surface crosses one of its elements.
void PairTruncation::accept_moved(const Points& after, Outcomes& outcomes) {
  std::vector<Index> moved;
  for (const Index i : blocked_by_obstacles(outcomes)) {
    const auto vertex = find_blocked(i);
    if (vertex != displacements_.blocked.end() && vertex->particle == i && vertex->surface) moved.push_back(i);
  }
  if (moved.empty()) return;
  regions_.renew_around(moved, {obstacles_, after, after, true});
  for (const Index i : moved) {
    const auto n = std::lower_bound(constrained_.begin(), constrained_.end(), i) - constrained_.begin();
    if (!regions_.is_crossed(i)) outcomes[static_cast<std::size_t>(n)] = Outcome::stopped;
  }
}

// A particle without an admissible position before the obstacles alone moved with one of them, which may have moved it through
// another obstacle or through another section of the same one.
void PairTruncation::check_unplaced(const Points& after, Outcomes& outcomes) {
  if (unplaced_.empty()) return;
  regions_.renew_around(unplaced_, {obstacles_, after, after, true});
  for (std::size_t k = 0; k < movable_.size(); ++k) {
    if (std::binary_search(unplaced_.begin(), unplaced_.end(), movable_[k]) && regions_.is_crossed(movable_[k])) {
      outcomes[k] = Outcome::infeasible;
    }
  }
}

Outcomes PairTruncation::of_movable(const Outcomes& of_constrained) const {
  Outcomes outcomes(movable_.size(), Outcome::free);
  std::size_t n = 0;
  for (std::size_t k = 0; k < movable_.size() && n < constrained_.size(); ++k) {
    if (movable_[k] == constrained_[n]) outcomes[k] = of_constrained[n++];
  }
  return outcomes;
}

std::vector<Index> PairTruncation::blocked_by_obstacles(const Outcomes& outcomes) const {
  std::vector<Index> found = particles_with(Outcome::infeasible, constrained_, outcomes);
  std::erase_if(found, [&](Index i) { return pairs_.crosses(i); });
  return found;
}

std::vector<BlockedVertex>::iterator PairTruncation::find_blocked(Index particle) {
  std::vector<BlockedVertex>& blocked = displacements_.blocked;
  return std::lower_bound(blocked.begin(), blocked.end(), particle, [](const BlockedVertex& a, Index b) { return a.particle < b; });
}

}  // namespace sprung
