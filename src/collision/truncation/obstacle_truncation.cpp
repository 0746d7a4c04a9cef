#include "collision/truncation/obstacle_truncation.h"

#include "base/sort_unique.h"
#include "collision/truncation/vertex_truncation.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace sprung {

namespace {

// A region stops a particle at a tangent plane of the obstacle. Renewed regions let it continue around the obstacle, in at most
// this many rounds.
constexpr int kRounds = 8;

// A particle continues if the last round moved it by at least kMinProgress of its path, and if at most kMaxRemaining of the path
// is left: a particle that is blocked for good would be moved far around the obstacle. A particle that is stopped only by the box
// of a region always continues, since no obstacle is known to block it.
constexpr double kMinProgress = 0x1p-10;
constexpr double kMaxRemaining = 0.5;

// If an obstacle approaches a pin, the other corners of the pin's elements swing around the pin. A corner may have to move this
// many times as far as the obstacle: the closer the obstacle is to the pin, the farther.
constexpr double kLevers[] = {1.0, 4.0, 16.0};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Replaces `particles` by `all`, which contains them; the added ones are free. All ascending.
void add_free(std::vector<Index> all, std::vector<Index>& particles, Outcomes& outcomes) {
  Outcomes of_all(all.size(), Outcome::free);
  std::size_t n = 0;
  for (std::size_t k = 0; k < all.size() && n < particles.size(); ++k) {
    if (all[k] == particles[n]) of_all[k] = outcomes[n++];
  }
  particles = std::move(all);
  outcomes = std::move(of_all);
}

// Crossed elements move with the obstacle as a whole; then the elements that they cross there do too.
constexpr int kElementRounds = 2;

/// Moves the infeasible ones of these particles with an obstacle, from `before` [m], 3 x n, and their neighbours too if an element
/// would be crossed otherwise. Changes `after` and the outcomes. Particles that move together with one obstacle stay on their side
/// of it, even if the planes of the regions are no longer sharp enough to prove it. So new regions at `after` decide: particles
/// with a crossed element there are infeasible.
void move_infeasible(ObstacleSafeRegions& regions, const ObstacleFrame& obstacles, const std::vector<Index>& particles,
                     const Points& before, Points& after, Outcomes& outcomes) {
  if (count(outcomes, Outcome::infeasible) == 0) return;
  const ObstacleMotion motion(regions, obstacles);
  std::vector<std::size_t> number(static_cast<std::size_t>(after.cols()), particles.size());
  std::vector<char> crossed_before(particles.size(), 0);
  std::vector<Index> moved;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const Index i = particles[n];
    number[static_cast<std::size_t>(i)] = n;
    crossed_before[n] = regions.is_crossed(i) ? 1 : 0;
    if (outcomes[n] != Outcome::infeasible) continue;
    const auto position = motion.moved(i, before.col(i));
    if (!position) continue;
    after.col(i) = *position;
    outcomes[n] = Outcome::stopped;
    moved.push_back(i);
  }
  regions.renew_around(moved, {obstacles, after, after, true});
  for (int round = 0; round < kElementRounds; ++round) {
    if (moved.empty()) break;
    moved.clear();
    for (const auto& [i, distance, position] : motion.moved_with_elements(before)) {
      const std::size_t n = number[static_cast<std::size_t>(i)];
      if (n == particles.size() || crossed_before[n] != 0) continue;
      after.col(i) = position;
      outcomes[n] = Outcome::stopped;
      moved.push_back(i);
    }
    regions.renew_around(moved, {obstacles, after, after, true});
  }
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (crossed_before[n] == 0 && regions.is_crossed(particles[n])) outcomes[n] = Outcome::infeasible;
  }
}

}  // namespace

ObstacleTruncation::ObstacleTruncation(const CollisionSurface& surface, ObstacleSafeRegions& regions)
    : surface_(surface), regions_(regions), truncation_(regions) {
  find_fixed();
}

void ObstacleTruncation::find_fixed() {
  fixed_.clear();
  for (Index i = 0; i < static_cast<Index>(surface_.motions.size()); ++i) {
    if (is_fixed(surface_.motions, i)) fixed_.push_back(i);
  }
}

TruncationResult ObstacleTruncation::clip_all(const StepPaths& paths, Points& after) {
  regions_.update(paths);
  record_crossed();
  regions_.renew_around(leaving_pins(paths.obstacles, paths.to), paths);
  std::vector<Index> particles = movable(regions_.leaving(), paths);
  Outcomes outcomes = clip_with_fresh_regions(particles, paths, after);
  bool subdivided = false;
  const bool path_checked = check_pins(paths.obstacles, particles, after, outcomes);
  if (!paths.at_end && (!path_checked || (is_kinematic(paths) && count(outcomes, Outcome::infeasible) > 0))) {
    add_free(all_movable(paths), particles, outcomes);
    if (path_checked) move_infeasible(regions_, paths.obstacles, particles, paths.from, after, outcomes);
    subdivided = !path_checked || count(outcomes, Outcome::infeasible) > 0;
    if (subdivided) {
      outcomes =
          clip_in_substeps(paths, after, [&](const StepPaths& substep, Points& x) { return clip_substep(particles, substep, x); });
    }
  }
  TruncationResult truncation = continue_stopped(particles, outcomes, paths, after);
  truncation.subdivided = subdivided;
  return truncation;
}

// Regions from earlier steps may stop a particle, or leave it no admissible position, although new ones would not. New regions
// bound the particle's neighbours too, which are clipped again.
Outcomes ObstacleTruncation::clip_with_fresh_regions(std::vector<Index>& particles, const StepPaths& paths, Points& after) {
  Outcomes outcomes = truncation_.clip(particles, paths, after);
  std::vector<Index> stopped;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] != Outcome::free) stopped.push_back(particles[n]);
  }
  if (stopped.empty()) return outcomes;
  regions_.renew_around(stopped, paths);
  const std::vector<Index> leaving = movable(regions_.leaving(), paths);
  std::vector<Index> all;
  std::set_union(particles.begin(), particles.end(), leaving.begin(), leaving.end(), std::back_inserter(all));
  particles = std::move(all);
  return truncation_.clip(particles, paths, after);
}

// A pin does not move out of the path of an obstacle. So the other corners of its elements have to leave that path before the
// obstacle arrives, farther than the obstacle moves.
ClippedSubstep ObstacleTruncation::clip_substep(std::vector<Index>& particles, const StepPaths& paths, Points& after) {
  ClippedSubstep clipped = clip_anew(particles, paths, after);
  if (fixed_.empty() || count(clipped.outcomes, Outcome::infeasible) == 0) return clipped;
  regions_.renew_around(fixed_, paths);
  const std::vector<Push> pushes = ObstacleMotion(regions_, paths.obstacles).pushes_at_pins(paths);
  if (pushes.empty()) return clip_anew(particles, paths, after);
  for (const double lever : kLevers) {
    Points goals = paths.to;
    for (const Push& push : pushes) {
      goals.col(push.particle) += std::min(lever, push.max_distance / push.displacement.norm()) * push.displacement;
    }
    clipped = clip_ahead(particles, paths, goals, after);
    if (count(clipped.outcomes, Outcome::infeasible) > 0) continue;
    for (std::size_t n = 0; n < particles.size(); ++n) {
      if (after.col(particles[n]) != paths.to.col(particles[n])) clipped.outcomes[n] = Outcome::stopped;
    }
    return clipped;
  }
  return clip_anew(particles, paths, after);
}

ClippedSubstep ObstacleTruncation::clip_anew(std::vector<Index>& particles, const StepPaths& paths, Points& after) {
  after = paths.to;
  regions_.update(paths);
  regions_.renew_around(fixed_, paths);
  regions_.renew_around(particles, paths);
  ClippedSubstep clipped{clip_with_fresh_regions(particles, paths, after)};
  move_infeasible(regions_, paths.obstacles, particles, paths.from, after, clipped.outcomes);
  clipped.path_checked = check_pins(paths.obstacles, particles, after, clipped.outcomes);
  return clipped;
}

// First the particles move while obstacles and pins stay at the begin of the interval. Then all move.
ClippedSubstep ObstacleTruncation::clip_ahead(std::vector<Index>& particles, const StepPaths& paths, const Points& goals,
                                              Points& after) {
  const ObstacleFrame at_begin = paths.obstacles.part(paths.obstacles.begin(), paths.obstacles.begin());
  Points first_goals = goals;
  for (const Index i : fixed_) first_goals.col(i) = paths.from.col(i);
  Points ahead = first_goals;
  const StepPaths first{at_begin, paths.from, first_goals, true};
  regions_.update(first);
  regions_.renew_around(particles, first);
  truncation_.clip(particles, first, ahead);
  return clip_anew(particles, {paths.obstacles, ahead, goals}, after);
}

bool ObstacleTruncation::is_kinematic(const StepPaths& paths) const {
  return paths.obstacles.set().moves() ||
         std::any_of(fixed_.begin(), fixed_.end(), [&](Index i) { return paths.from.col(i) != paths.to.col(i); });
}

void ObstacleTruncation::record_crossed() {
  crossed_before_.clear();
  if (!regions_.any_crossed()) return;
  for (std::size_t i = 0; i < surface_.motions.size(); ++i) {
    crossed_before_.push_back(regions_.is_crossed(static_cast<Index>(i)) ? 1 : 0);
  }
}

std::vector<Index> ObstacleTruncation::leaving_pins(const ObstacleFrame& obstacles, const Points& positions) const {
  std::vector<Index> leaving;
  for (const Index i : fixed_) {
    if (!regions_.is_at_rest(i) && positions.col(i).allFinite() && !regions_.allow(obstacles, i, positions.col(i)))
      leaving.push_back(i);
  }
  return leaving;
}

// Pins are not clipped. If one leaves its regions, crossings are known only for its end position.
bool ObstacleTruncation::check_pins(const ObstacleFrame& obstacles, const std::vector<Index>& particles, const Points& after,
                                    Outcomes& outcomes) {
  const std::vector<Index> leaving = leaving_pins(obstacles, after);
  if (!leaving.empty()) regions_.renew_around(leaving, {obstacles, after, after, true});
  if (!regions_.any_crossed()) return leaving.empty();
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const Index i = particles[n];
    if (regions_.is_crossed(i) && (crossed_before_.empty() || crossed_before_[at(i)] == 0)) outcomes[n] = Outcome::infeasible;
  }
  return leaving.empty();
}

TruncationResult ObstacleTruncation::continue_stopped(const std::vector<Index>& particles, const Outcomes& outcomes,
                                                      const StepPaths& paths, Points& after) {
  std::vector<Index> stopped = particles_with(Outcome::stopped, particles, outcomes);
  stopped_ = stopped;
  TruncationResult truncation;
  truncation.truncated = count(outcomes, Outcome::infeasible) + static_cast<Index>(stopped.size());
  list_infeasible(particles, outcomes);
  truncation.infeasible = static_cast<Index>(infeasible_.size());
  std::erase_if(stopped, [&](Index i) { return !can_continue(i, paths, after); });
  for (int round = 1; round < kRounds && !stopped.empty(); ++round) truncation.truncated -= continue_once(stopped, paths, after);
  return truncation;
}

Index ObstacleTruncation::continue_once(std::vector<Index>& stopped, const StepPaths& paths, Points& after) {
  const Points from = after;
  const StepPaths remaining{paths.obstacles, from, paths.to, true};
  regions_.renew_around(stopped, remaining);
  const Outcomes outcomes = truncation_.clip(stopped, remaining, after);
  std::vector<Index> still;
  for (std::size_t n = 0; n < stopped.size(); ++n) {
    if (outcomes[n] != Outcome::free && can_continue(stopped[n], remaining, after)) still.push_back(stopped[n]);
  }
  stopped = std::move(still);
  return count(outcomes, Outcome::free);
}

bool ObstacleTruncation::can_continue(Index i, const StepPaths& paths, const Points& now) const {
  const double length = (paths.to.col(i) - paths.from.col(i)).norm();
  const double moved = (now.col(i) - paths.from.col(i)).norm();
  const double left = (paths.to.col(i) - now.col(i)).norm();
  return moved > kMinProgress * length &&
         (left <= kMaxRemaining * length || regions_.planes_allow(paths.obstacles, i, paths.to.col(i)));
}

// Corners of crossed elements are listed even if they are fixed or were not clipped.
void ObstacleTruncation::list_infeasible(const std::vector<Index>& particles, const Outcomes& outcomes) {
  infeasible_ = particles_with(Outcome::infeasible, particles, outcomes);
  if (!regions_.any_crossed()) return;
  for (Index i = 0; i < static_cast<Index>(surface_.motions.size()); ++i) {
    if (regions_.is_crossed(i)) infeasible_.push_back(i);
  }
  sort_unique(infeasible_);
}

std::vector<Index> ObstacleTruncation::movable(std::vector<Index> particles, const StepPaths& paths) const {
  std::erase_if(particles, [&](Index i) {
    return is_fixed(surface_.motions, i) || !paths.from.col(i).allFinite() || !paths.to.col(i).allFinite();
  });
  return particles;
}

std::vector<Index> ObstacleTruncation::all_movable(const StepPaths& paths) const {
  std::vector<Index> particles(at(static_cast<Index>(paths.to.cols())));
  std::iota(particles.begin(), particles.end(), 0);
  return movable(std::move(particles), paths);
}

}  // namespace sprung
