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

std::vector<Index> find_infeasible(const std::vector<Index>& particles, const Outcomes& outcomes) {
  std::vector<Index> found;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::infeasible) found.push_back(particles[n]);
  }
  return found;
}

}  // namespace

PairTruncation::PairTruncation(const ObstacleFrame& obstacles, ObstacleSafeRegions& regions, PairSeparation& pairs,
                               const std::vector<Index>& movable)
    : obstacles_(obstacles), regions_(regions), pairs_(pairs), movable_(movable) {}

// The loop ends: each round makes at least one particle an anchor, or a resting anchor move, and neither is undone.
Outcomes PairTruncation::clip(const Points& before, Points& after) {
  const Points allowed = after;
  Outcomes outcomes = clip_constrained(before, after);
  if (count(outcomes, Outcome::infeasible) > 0) {
    const StepPaths paths{obstacles_, before, allowed};
    for (int round = 0; anchor_infeasible(outcomes, before, after); ++round) {
      if (round == 0) regions_.update(paths);
      regions_.renew_around(round < kLocalRounds ? blocked_by_obstacles(outcomes) : movable_, paths);
      clip_before_obstacles(paths, after);
      outcomes = clip_constrained(before, after);
    }
    accept_anchored(after, outcomes);
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
  unplaced_ = find_infeasible(movable_, truncation.clip(movable_, paths, after));
  for (int round = 0; round < kMaxRenewals && !unplaced_.empty(); ++round) {
    regions_.renew_around(unplaced_, paths);
    const std::vector<Index> last = std::exchange(unplaced_, find_infeasible(movable_, truncation.clip(movable_, paths, after)));
    if (unplaced_ == last) break;
  }
}

bool PairTruncation::anchor_infeasible(const Outcomes& outcomes, const Points& before, const Points& after) {
  bool changed = false;
  for (const Index i : blocked_by_obstacles(outcomes)) {
    const KinematicAnchor anchor = ObstacleMotion(regions_, obstacles_).anchor(i, before.col(i), after.col(i));
    const auto found = find_anchor(i);
    if (found == displacements_.anchors.end() || found->particle != i) {
      displacements_.anchors.insert(found, anchor);
    } else if (anchor.moves() && !found->moves()) {
      *found = anchor;
    } else {
      continue;
    }
    changed = true;
  }
  return changed;
}

// Before a deforming surface a region shrinks by all motion that differs from the motion of the closest points. That may leave no
// room. So a particle that moved with the surface is infeasible only if the surface crosses one of its elements.
void PairTruncation::accept_anchored(const Points& after, Outcomes& outcomes) {
  std::vector<Index> anchored;
  for (const Index i : blocked_by_obstacles(outcomes)) {
    const auto anchor = find_anchor(i);
    if (anchor != displacements_.anchors.end() && anchor->particle == i && anchor->surface) anchored.push_back(i);
  }
  if (anchored.empty()) return;
  regions_.renew_around(anchored, {obstacles_, after, after, true});
  for (const Index i : anchored) {
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
  std::vector<Index> found = find_infeasible(constrained_, outcomes);
  std::erase_if(found, [&](Index i) { return pairs_.passes(i); });
  return found;
}

std::vector<KinematicAnchor>::iterator PairTruncation::find_anchor(Index particle) {
  std::vector<KinematicAnchor>& anchors = displacements_.anchors;
  return std::lower_bound(anchors.begin(), anchors.end(), particle,
                          [](const KinematicAnchor& a, Index b) { return a.particle < b; });
}

}  // namespace sprung
