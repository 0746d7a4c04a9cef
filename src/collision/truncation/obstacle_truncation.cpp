#include "collision/truncation/obstacle_truncation.h"

#include "collision/truncation/move_trapped.h"
#include "collision/truncation/time_subdivision.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace sprung {

namespace {

// Zones are made again where they stopped a particle short, so that it can go on, at most so often.
constexpr int kRounds = 8;

// It goes on if the last round took it this part of its way or more, and no more than that part is left where a plane is in its
// way: what was stopped for good would be led a long way round the obstacle. Where a box alone ends, nothing is known to be in its
// way.
constexpr double kWorthwhile = 0x1p-10;
constexpr double kMostLeft = 0.5;

// What an obstacle leads round a pin goes so many times as far as the obstacle, the nearer to the pin the more.
constexpr double kLevers[] = {1.0, 4.0, 16.0};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Adds those of `all`, which hold the particles, that are not among them: they arrived. All ascending.
void add_free(std::vector<Index> all, std::vector<Index>& particles, Outcomes& outcomes) {
  Outcomes of_all(all.size(), Outcome::free);
  std::size_t n = 0;
  for (std::size_t k = 0; k < all.size() && n < particles.size(); ++k) {
    if (all[k] == particles[n]) of_all[k] = outcomes[n++];
  }
  particles = std::move(all);
  outcomes = std::move(of_all);
}

}  // namespace

ObstacleTruncation::ObstacleTruncation(Environment& environment, const CollisionSurface& surface, ObstacleSafeRegions& regions)
    : environment_(environment), set_(environment.set()), surface_(surface), regions_(regions) {
  for (std::size_t i = 0; i < surface.pinned.size(); ++i) {
    if (surface.pinned[i] != 0) pinned_.push_back(static_cast<Index>(i));
  }
}

TruncationResult ObstacleTruncation::place_all(const Way& way, Points& after) {
  regions_.follow(way);
  note_crossed();
  regions_.renew_around(leaving_pins(way.to), way);
  std::vector<Index> particles = movable(regions_.restless(), way);
  Outcomes outcomes = clip_with_fresh_regions(particles, way, after);
  bool in_parts = false;
  const bool sure = look_at_pins(particles, after, outcomes);
  if (!way.obstacles_rest && (!sure || (closes_in(way) && count(outcomes, Outcome::infeasible) > 0))) {
    add_free(all_movable(way), particles, outcomes);
    if (sure) move_infeasible(regions_, particles, way.from, after, outcomes);
    in_parts = !sure || count(outcomes, Outcome::infeasible) > 0;
    if (in_parts) {
      outcomes =
          place_in_parts(environment_, way, after, [&](const Way& part, Points& x) { return place_part(particles, part, x); });
    }
  }
  TruncationResult truncation = lead_on(particles, outcomes, way, after);
  truncation.subdivided = in_parts;
  return truncation;
}

// Zones that were made some steps ago may stop a particle, or leave it no place at all, where new ones would not. Those are their
// neighbours' too.
Outcomes ObstacleTruncation::clip_with_fresh_regions(std::vector<Index>& particles, const Way& way, Points& after) {
  Outcomes outcomes = place(regions_, particles, way, after);
  std::vector<Index> stopped;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] != Outcome::free) stopped.push_back(particles[n]);
  }
  if (stopped.empty()) return outcomes;
  regions_.renew_around(stopped, way);
  const std::vector<Index> restless = movable(regions_.restless(), way);
  std::vector<Index> all;
  std::set_union(particles.begin(), particles.end(), restless.begin(), restless.end(), std::back_inserter(all));
  particles = std::move(all);
  return place(regions_, particles, way, after);
}

// What an obstacle leads round a pin is to be out of its way before it comes, and farther than the obstacle goes: the pin stays.
ClippedSubstep ObstacleTruncation::place_part(std::vector<Index>& particles, const Way& part, Points& after) {
  ClippedSubstep placed = place_anew(particles, part, after);
  if (pinned_.empty() || count(placed.outcomes, Outcome::infeasible) == 0) return placed;
  regions_.renew_around(pinned_, part);
  const std::vector<Push> pushes = regions_.pushes_at_pins(part);
  if (pushes.empty()) return place_anew(particles, part, after);
  for (const double lever : kLevers) {
    Points goals = part.to;
    for (const Push& push : pushes) goals.col(push.particle) += std::min(lever, push.most / push.by.norm()) * push.by;
    placed = place_ahead(particles, part, goals, after);
    if (count(placed.outcomes, Outcome::infeasible) > 0) continue;
    for (std::size_t n = 0; n < particles.size(); ++n) {
      if (after.col(particles[n]) != part.to.col(particles[n])) placed.outcomes[n] = Outcome::stopped;
    }
    return placed;
  }
  return place_anew(particles, part, after);
}

ClippedSubstep ObstacleTruncation::place_anew(std::vector<Index>& particles, const Way& way, Points& after) {
  after = way.to;
  regions_.follow(way);
  regions_.renew_around(pinned_, way);
  regions_.renew_around(particles, way);
  ClippedSubstep placed{clip_with_fresh_regions(particles, way, after)};
  move_infeasible(regions_, particles, way.from, after, placed.outcomes);
  placed.sure = look_at_pins(particles, after, placed.outcomes);
  return placed;
}

/// First particles go while obstacles and pins are where they were, then these.
ClippedSubstep ObstacleTruncation::place_ahead(std::vector<Index>& particles, const Way& part, const Points& goals, Points& after) {
  const auto [begin, end] = environment_.interval();
  Points first_goals = goals;
  for (const Index i : pinned_) first_goals.col(i) = part.from.col(i);
  Points ahead = first_goals;
  const Way first{part.from, first_goals, true};
  environment_.set_interval(begin, begin);
  regions_.follow(first);
  regions_.renew_around(particles, first);
  place(regions_, particles, first, ahead);
  environment_.set_interval(begin, end);
  return place_anew(particles, {ahead, goals}, after);
}

bool ObstacleTruncation::closes_in(const Way& way) const {
  return set_.moves() || std::any_of(pinned_.begin(), pinned_.end(), [&](Index i) { return way.from.col(i) != way.to.col(i); });
}

void ObstacleTruncation::note_crossed() {
  crossed_before_.clear();
  if (!regions_.crosses()) return;
  for (std::size_t i = 0; i < surface_.pinned.size(); ++i) {
    crossed_before_.push_back(regions_.is_crossed(static_cast<Index>(i)) ? 1 : 0);
  }
}

std::vector<Index> ObstacleTruncation::leaving_pins(const Points& positions) const {
  std::vector<Index> leaving;
  for (const Index i : pinned_) {
    if (positions.col(i).allFinite() && !regions_.allow(i, positions.col(i))) leaving.push_back(i);
  }
  return leaving;
}

// Pins ask nobody. Where regions do not hold them, whether an obstacle crosses an element is known for where they are alone.
bool ObstacleTruncation::look_at_pins(const std::vector<Index>& particles, const Points& after, Outcomes& outcomes) {
  const std::vector<Index> leaving = leaving_pins(after);
  if (!leaving.empty()) regions_.renew_around(leaving, {after, after, true});
  if (!regions_.crosses()) return leaving.empty();
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const Index i = particles[n];
    if (regions_.is_crossed(i) && (crossed_before_.empty() || crossed_before_[at(i)] == 0)) outcomes[n] = Outcome::infeasible;
  }
  return leaving.empty();
}

TruncationResult ObstacleTruncation::lead_on(const std::vector<Index>& particles, const Outcomes& outcomes, const Way& way,
                                             Points& after) {
  std::vector<Index> stopped;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::stopped) stopped.push_back(particles[n]);
  }
  held_back_ = stopped;
  TruncationResult truncation;
  truncation.truncated = count(outcomes, Outcome::infeasible) + static_cast<Index>(stopped.size());
  list_infeasible(particles, outcomes);
  truncation.infeasible = static_cast<Index>(infeasible_.size());
  std::erase_if(stopped, [&](Index i) { return !can_go_on(i, way, after); });
  for (int round = 1; round < kRounds && !stopped.empty(); ++round) truncation.truncated -= go_on(stopped, way.to, after);
  return truncation;
}

// A region ends where it meets the obstacle's tangent; from there a new one leads round the obstacle.
Index ObstacleTruncation::go_on(std::vector<Index>& stopped, const Points& target, Points& after) {
  const Points from = after;
  const Way way{from, target, true};
  regions_.renew_around(stopped, way);
  const Outcomes outcomes = place(regions_, stopped, way, after);
  std::vector<Index> still;
  for (std::size_t n = 0; n < stopped.size(); ++n) {
    if (outcomes[n] != Outcome::free && can_go_on(stopped[n], way, after)) still.push_back(stopped[n]);
  }
  stopped = std::move(still);
  return count(outcomes, Outcome::free);
}

bool ObstacleTruncation::can_go_on(Index i, const Way& way, const Points& now) const {
  const double length = (way.to.col(i) - way.from.col(i)).norm();
  const double gone = (now.col(i) - way.from.col(i)).norm();
  const double left = (way.to.col(i) - now.col(i)).norm();
  return gone > kWorthwhile * length && (left <= kMostLeft * length || regions_.planes_allow(i, way.to.col(i)));
}

/// Pinned ones too.
void ObstacleTruncation::list_infeasible(const std::vector<Index>& particles, const Outcomes& outcomes) {
  infeasible_.clear();
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::infeasible) infeasible_.push_back(particles[n]);
  }
  if (!regions_.crosses()) return;
  for (Index i = 0; i < static_cast<Index>(surface_.pinned.size()); ++i) {
    if (regions_.is_crossed(i)) infeasible_.push_back(i);
  }
  std::sort(infeasible_.begin(), infeasible_.end());
  infeasible_.erase(std::unique(infeasible_.begin(), infeasible_.end()), infeasible_.end());
}

std::vector<Index> ObstacleTruncation::movable(std::vector<Index> particles, const Way& way) const {
  std::erase_if(particles,
                [&](Index i) { return surface_.pinned[at(i)] != 0 || !way.from.col(i).allFinite() || !way.to.col(i).allFinite(); });
  return particles;
}

std::vector<Index> ObstacleTruncation::all_movable(const Way& way) const {
  std::vector<Index> particles(at(static_cast<Index>(way.to.cols())));
  std::iota(particles.begin(), particles.end(), 0);
  return movable(std::move(particles), way);
}

}  // namespace sprung
