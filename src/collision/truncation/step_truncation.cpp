#include "collision/truncation/step_truncation.h"

#include "base/sort_unique.h"
#include "collision/truncation/obstacle_truncation.h"
#include "collision/truncation/pair_truncation.h"
#include "collision/truncation/vertex_truncation.h"

#include <algorithm>
#include <optional>

namespace sprung {

namespace {

void append(const std::vector<Index>& more, std::vector<Index>& all) { all.insert(all.end(), more.begin(), more.end()); }

bool bodies_collide(const CollisionSurface& surface) { return std::count(surface.others.begin(), surface.others.end(), 1) > 1; }

/// Whether elements of one body or of two bodies may touch.
bool network_collides(const CollisionSurface& surface) {
  return std::count(surface.self.begin(), surface.self.end(), 1) > 0 || bodies_collide(surface);
}

}  // namespace

struct StepTruncation::Implementation {
  Implementation(const ObstacleSet& obstacles, CollisionSurface elements, const Points& rest, double margin)
      : has_obstacles(!obstacles.empty()),
        surface(std::move(elements)),
        regions(obstacles, surface, rest, margin),
        obstacle_truncation(surface, regions) {
    if (network_collides(surface)) pairs.emplace(surface, rest, margin);
  }

  void begin_pairs(const Points& before, const Points& after);
  TruncationResult truncate(const ObstacleFrame& obstacles, const Points& before, Points& after, const Relax& relax);
  void separate_pairs(const ObstacleFrame& obstacles, const Points& before, Points& after, TruncationResult& truncation);

  bool has_obstacles;
  CollisionSurface surface;
  ObstacleSafeRegions regions;
  ObstacleTruncation obstacle_truncation;
  std::optional<PairSeparation> pairs;  ///< if elements of the network may touch
  std::vector<Contact> contacts{};
  std::vector<Contact> pair_contacts{};  ///< of the step that begin_step() began
  bool pairs_begun = false;
};

StepTruncation::StepTruncation(const ObstacleSet& obstacles, CollisionSurface surface, const Points& rest, double margin)
    : implementation_(std::make_unique<Implementation>(obstacles, std::move(surface), rest, margin)) {}
StepTruncation::~StepTruncation() = default;
StepTruncation::StepTruncation(StepTruncation&&) noexcept = default;
StepTruncation& StepTruncation::operator=(StepTruncation&&) noexcept = default;

bool StepTruncation::can_collide() const { return implementation_->pairs.has_value() || implementation_->has_obstacles; }

bool StepTruncation::bodies_can_collide() const { return bodies_collide(implementation_->surface); }

void StepTruncation::set_motions(ParticleMotions motions) {
  implementation_->surface.motions = std::move(motions);
  implementation_->regions.find_fixed();
  implementation_->obstacle_truncation.find_fixed();
  roll_back({});
}

void StepTruncation::begin_step(const ObstacleFrame& obstacles, const Points& before, const Points& after) {
  const StepPaths paths{obstacles, before, after};
  implementation_->regions.update(paths);
  implementation_->regions.permit_crossings(before);
  if (implementation_->pairs) implementation_->begin_pairs(before, after);
}

const PermittedCrossings& StepTruncation::permitted_crossings() const { return implementation_->regions.permitted_crossings(); }

void StepTruncation::roll_back(const PermittedCrossings& permitted) {
  implementation_->regions.roll_back(permitted);
  if (implementation_->pairs) implementation_->pairs->forget();
}

void StepTruncation::save(ByteWriter& to) const {
  implementation_->regions.save(to);
  to.write(implementation_->pairs);
}

void StepTruncation::load(BinaryReader& from) {
  implementation_->regions.load(from);
  bool has_pairs = false;
  from.read(has_pairs);
  if (has_pairs != implementation_->pairs.has_value()) throw BytesError();
  if (has_pairs) from.read(*implementation_->pairs);
}

const std::vector<Contact>& StepTruncation::contacts(const ObstacleFrame& obstacles, const Points& before, const Points& after) {
  implementation_->contacts.clear();
  implementation_->regions.find_contacts({obstacles, before, after}, implementation_->contacts);
  const std::vector<Contact>& between_elements = implementation_->pair_contacts;
  implementation_->contacts.insert(implementation_->contacts.end(), between_elements.begin(), between_elements.end());
  return implementation_->contacts;
}

FreshContacts StepTruncation::renewed_contacts(const ObstacleFrame& obstacles, const Points& before, const Points& after) {
  return implementation_->regions.find_contacts_around(implementation_->obstacle_truncation.stopped(), {obstacles, before, after});
}

TruncationResult StepTruncation::truncate(const ObstacleFrame& obstacles, const Points& before, Points& after, const Relax& relax) {
  TruncationResult truncation;
  if (implementation_->has_obstacles) truncation = implementation_->truncate(obstacles, before, after, relax);
  if (implementation_->pairs_begun) implementation_->separate_pairs(obstacles, before, after, truncation);
  return truncation;
}

// A state with infeasible particles is not safe to continue from. Otherwise the loop ends when `relax` returns false.
TruncationResult StepTruncation::Implementation::truncate(const ObstacleFrame& obstacles, const Points& before, Points& after,
                                                          const Relax& relax) {
  Points target = after;
  TruncationResult truncation = obstacle_truncation.clip_all({obstacles, before, target}, after);
  if (truncation.truncated == 0 || !relax) return truncation;
  for (Points safe = after; truncation.infeasible == 0 && relax(after); safe = after) {
    target = after;
    truncation = obstacle_truncation.clip_all({obstacles, safe, target, true}, after);
  }
  return truncation;
}

void StepTruncation::Implementation::begin_pairs(const Points& before, const Points& after) {
  pair_contacts.clear();
  pairs_begun = before.allFinite() && after.allFinite();
  if (pairs_begun) pairs->begin_step(before, after, pair_contacts);
}

void StepTruncation::Implementation::separate_pairs(const ObstacleFrame& obstacles, const Points& before, Points& after,
                                                    TruncationResult& truncation) {
  if (!after.allFinite()) return;
  std::vector<Index> particles = obstacle_truncation.all_movable({obstacles, before, after});
  const Points allowed = after;
  const auto record_moved = [&] { append(pairs->moved_with_obstacle(), truncation.moved_with_obstacles); };
  Outcomes outcomes = PairTruncation(obstacles, regions, *pairs, particles).clip(before, after);
  record_moved();
  std::vector<Index> infeasible = pairs->crossing_fixed();
  const bool path_checked = obstacle_truncation.check_pins(obstacles, particles, after, outcomes);
  if (!path_checked ||
      (obstacle_truncation.is_kinematic({obstacles, before, allowed}) && count(outcomes, Outcome::infeasible) > 0)) {
    infeasible.clear();
    truncation.subdivided = true;
    truncation.moved_with_obstacles.clear();
    outcomes = clip_in_substeps({obstacles, before, allowed}, after, [&](const StepPaths& paths, Points& x) {
      const ClippedSubstep before_obstacles = obstacle_truncation.clip_substep(particles, paths, x);
      pairs->begin_substep(paths.from, x);
      ClippedSubstep clipped{PairTruncation(paths.obstacles, regions, *pairs, particles).clip(paths.from, x),
                             before_obstacles.path_checked};
      record_moved();
      append(pairs->crossing_fixed(), infeasible);
      clipped.path_checked =
          obstacle_truncation.check_pins(paths.obstacles, particles, x, clipped.outcomes) && clipped.path_checked;
      keep_infeasible(before_obstacles.outcomes, clipped.outcomes);
      return clipped;
    });
  }
  truncation.truncated += static_cast<Index>(outcomes.size()) - count(outcomes, Outcome::free);
  append(obstacle_truncation.infeasible(), infeasible);
  append(particles_with(Outcome::infeasible, particles, outcomes), infeasible);
  const bool stops = count(outcomes, Outcome::free) < static_cast<Index>(outcomes.size());
  if (stops && !truncation.subdivided) pairs->append_closest_contacts(before, truncation.body_contacts);
  sort_unique(infeasible);
  truncation.infeasible = static_cast<Index>(infeasible.size());
}

}  // namespace sprung
