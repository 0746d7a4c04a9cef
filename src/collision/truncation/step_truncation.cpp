#include "collision/truncation/step_truncation.h"

#include "collision/truncation/obstacle_truncation.h"
#include "collision/truncation/pair_truncation.h"
#include "collision/truncation/time_subdivision.h"

#include <algorithm>
#include <optional>

namespace sprung {

namespace {

bool bodies_meet(const CollisionSurface& surface) { return std::count(surface.others.begin(), surface.others.end(), 1) > 1; }

/// Whether elements of one body or of two may meet.
bool meets_itself(const CollisionSurface& surface) {
  return std::count(surface.self.begin(), surface.self.end(), 1) > 0 || bodies_meet(surface);
}

}  // namespace

struct StepTruncation::Implementation {
  Implementation(Environment& world, CollisionSurface elements, const Points& rest, double margin)
      : environment(world),
        set(world.set()),
        surface(std::move(elements)),
        regions(set, surface, rest, margin),
        placement(environment, surface, regions) {
    if (meets_itself(surface)) pairs.emplace(surface, rest, margin);
  }

  void begin_pairs(const Points& before, const Points& after);
  TruncationResult truncate(const Points& before, Points& after, const Relax& relax);
  void keep_apart(const Points& before, Points& after, TruncationResult& truncation);

  Environment& environment;
  const ObstacleSet& set;
  CollisionSurface surface;
  ObstacleSafeRegions regions;
  ObstacleTruncation placement;
  bool ahead = false;                   ///< see look_ahead
  std::optional<PairSeparation> pairs;  ///< where elements of the network may meet
  std::vector<Contact> contacts{};
  std::vector<Contact> pair_contacts{};  ///< of the step that follow() began
  bool pairs_began = false;
};

StepTruncation::StepTruncation(Environment& environment, CollisionSurface surface, const Points& rest, double margin)
    : implementation_(std::make_unique<Implementation>(environment, std::move(surface), rest, margin)) {}
StepTruncation::~StepTruncation() = default;
StepTruncation::StepTruncation(StepTruncation&&) noexcept = default;
StepTruncation& StepTruncation::operator=(StepTruncation&&) noexcept = default;

bool StepTruncation::can_collide() const { return implementation_->pairs.has_value() || !implementation_->set.obstacles().empty(); }

bool StepTruncation::bodies_can_collide() const { return bodies_meet(implementation_->surface); }

void StepTruncation::follow(const Points& before, const Points& after) {
  implementation_->regions.follow({before, after});
  implementation_->regions.permit_crossings(before);
  if (implementation_->ahead) implementation_->regions.renew_around(implementation_->placement.pinned(), {before, after});
  if (implementation_->pairs) implementation_->begin_pairs(before, after);
}

const PermittedCrossings& StepTruncation::permitted_crossings() const { return implementation_->regions.permitted_crossings(); }

void StepTruncation::roll_back(const PermittedCrossings& permitted) {
  implementation_->regions.roll_back(permitted);
  if (implementation_->pairs) implementation_->pairs->forget();
}

void StepTruncation::look_ahead(bool ahead) {
  implementation_->ahead = ahead;
  implementation_->regions.look_ahead(ahead);
}

const std::vector<Contact>& StepTruncation::contacts(const Points& before, const Points& after) {
  implementation_->contacts.clear();
  implementation_->regions.find_contacts({before, after}, implementation_->contacts);
  const std::vector<Contact>& of_pairs = implementation_->pair_contacts;
  implementation_->contacts.insert(implementation_->contacts.end(), of_pairs.begin(), of_pairs.end());
  return implementation_->contacts;
}

FreshContacts StepTruncation::renewed_contacts(const Points& before, const Points& after) {
  return implementation_->regions.find_contacts_around(implementation_->placement.held_back(), {before, after});
}

TruncationResult StepTruncation::truncate(const Points& before, Points& after, const Relax& relax) {
  TruncationResult truncation;
  if (!implementation_->set.obstacles().empty()) truncation = implementation_->truncate(before, after, relax);
  if (implementation_->pairs_began) implementation_->keep_apart(before, after, truncation);
  return truncation;
}

// What found no free place is not safe to go on from.
TruncationResult StepTruncation::Implementation::truncate(const Points& before, Points& after, const Relax& relax) {
  Points target = after;
  TruncationResult truncation = placement.place_all({before, target}, after);
  if (truncation.truncated == 0 || !relax) return truncation;
  for (Points safe = after; truncation.infeasible == 0 && relax(after); safe = after) {
    target = after;
    truncation = placement.place_all({safe, target, true}, after);
  }
  return truncation;
}

void StepTruncation::Implementation::begin_pairs(const Points& before, const Points& after) {
  pair_contacts.clear();
  pairs_began = before.allFinite() && after.allFinite();
  if (pairs_began) pairs->begin_step(before, after, pair_contacts);
}

void StepTruncation::Implementation::keep_apart(const Points& before, Points& after, TruncationResult& truncation) {
  if (!after.allFinite()) return;
  std::vector<Index> particles = placement.all_movable({before, after});
  const Points allowed = after;
  const auto note_taken_along = [&] {
    const std::vector<Index>& taken = pairs->taken_along();
    truncation.moved_with_obstacles.insert(truncation.moved_with_obstacles.end(), taken.begin(), taken.end());
  };
  Outcomes outcomes = PairTruncation(regions, *pairs, particles).place(before, after);
  note_taken_along();
  std::vector<Index> infeasible = pairs->passing_pins();
  const bool sure = placement.look_at_pins(particles, after, outcomes);
  if (!sure || (placement.closes_in({before, allowed}) && count(outcomes, Outcome::infeasible) > 0)) {
    infeasible.clear();
    truncation.subdivided = true;
    truncation.moved_with_obstacles.clear();
    outcomes = place_in_parts(environment, {before, allowed}, after, [&](const Way& part, Points& x) {
      const ClippedSubstep among_obstacles = placement.place_part(particles, part, x);
      pairs->begin_part(part.from, x);
      ClippedSubstep placed{PairTruncation(regions, *pairs, particles).place(part.from, x), among_obstacles.sure};
      note_taken_along();
      const std::vector<Index> pins = pairs->passing_pins();
      infeasible.insert(infeasible.end(), pins.begin(), pins.end());
      placed.sure = placement.look_at_pins(particles, x, placed.outcomes) && placed.sure;
      keep_infeasible(among_obstacles.outcomes, placed.outcomes);
      return placed;
    });
  }
  truncation.truncated += static_cast<Index>(outcomes.size()) - count(outcomes, Outcome::free);
  infeasible.insert(infeasible.end(), placement.infeasible().begin(), placement.infeasible().end());
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::infeasible) infeasible.push_back(particles[n]);
  }
  const bool stops = count(outcomes, Outcome::free) < static_cast<Index>(outcomes.size());
  if (stops && !truncation.subdivided) pairs->append_meetings(before, truncation.body_contacts);
  std::sort(infeasible.begin(), infeasible.end());
  truncation.infeasible = static_cast<Index>(std::unique(infeasible.begin(), infeasible.end()) - infeasible.begin());
}

}  // namespace sprung
