#include "collision/free_space.h"

#include "collision/carried_placement.h"
#include "collision/pair_placement.h"
#include "collision/placement_in_parts.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>

namespace sprung {

namespace {

// Zones are made again where they stopped a particle short, so that it can go on, at most so often.
constexpr int kRounds = 8;

// It goes on if the last round took it this part of its way or more, and no more than that part is left: what was stopped for good
// would be led a long way round the obstacle.
constexpr double kWorthwhile = 0x1p-10;
constexpr double kMostLeft = 0.5;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Whether elements of one body or of two may meet.
bool meets_itself(const CollisionSurface& surface) {
  return std::count(surface.self.begin(), surface.self.end(), 1) > 0 ||
         std::count(surface.others.begin(), surface.others.end(), 1) > 1;
}

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

struct FreeSpace::Implementation {
  Implementation(Environment& world, CollisionSurface elements, const Points& rest, double margin)
      : environment(world), set(world.set()), surface(std::move(elements)), zones(set, surface, rest, margin) {
    if (meets_itself(surface)) pairs.emplace(surface, rest, margin);
  }

  void begin_pairs(const Points& before, const Points& after);
  const std::vector<Contact>& with_pairs();
  Truncation truncate(const Points& before, Points& after, const Relax& relax);
  Truncation place_all(const Way& way, Points& after);
  void look_at_pins(const Points& after);
  Truncation lead_on(const std::vector<Index>& particles, const Outcomes& outcomes, const Way& way, Points& after);
  void keep_apart(const Points& before, Points& after, Truncation& truncation);
  /// Particles, pinned ones too, that are not squeezed but of whose elements an obstacle crosses one.
  [[nodiscard]] Index crossed(const std::vector<Index>& particles, const Outcomes& outcomes) const;
  [[nodiscard]] std::vector<Index> movable(std::vector<Index> particles, const Way& way) const;
  [[nodiscard]] std::vector<Index> all_movable(const Way& way) const;
  /// Places all movable particles, by themselves, in a part of the environment's interval.
  Outcomes place_part(std::vector<Index>& particles, const Way& part, Points& after);
  [[nodiscard]] static bool can_go_on(Index particle, const Points& from, const Points& target, const Points& now);
  /// Leaves in `stopped` those that may come farther yet; returns how many arrived.
  Index go_on(std::vector<Index>& stopped, const Points& target, Points& after);
  /// Particles are ascending; those that may be held back too are added.
  Outcomes place_with_fresh_zones(std::vector<Index>& particles, const Way& way, Points& positions);

  Environment& environment;
  const ObstacleSet& set;
  CollisionSurface surface;
  ObstacleZones zones;
  std::optional<SelfZones> pairs;  ///< where elements of the network may meet
  std::vector<Index> held_back{};  ///< particles that did not arrive at once when they were placed last
  std::vector<Contact> contacts{};
  std::vector<Contact> pair_contacts{};  ///< of the step that follow() began
  bool pairs_began = false;
};

FreeSpace::FreeSpace(Environment& environment, CollisionSurface surface, const Points& rest, double margin)
    : implementation_(std::make_unique<Implementation>(environment, std::move(surface), rest, margin)) {}
FreeSpace::~FreeSpace() = default;
FreeSpace::FreeSpace(FreeSpace&&) noexcept = default;
FreeSpace& FreeSpace::operator=(FreeSpace&&) noexcept = default;

bool FreeSpace::meets_anything() const { return implementation_->pairs.has_value() || !implementation_->set.obstacles().empty(); }

void FreeSpace::follow(const Points& before, const Points& after) {
  implementation_->zones.follow({before, after});
  implementation_->zones.let_through(before);
  if (implementation_->pairs) implementation_->begin_pairs(before, after);
}

const std::vector<Contact>& FreeSpace::contacts(const Points& before, const Points& after) {
  implementation_->contacts.clear();
  implementation_->zones.find_contacts({before, after}, implementation_->contacts);
  return implementation_->with_pairs();
}

const std::vector<Contact>& FreeSpace::contacts_again(const Points& before, const Points& after) {
  implementation_->contacts.clear();
  implementation_->zones.find_contacts_around(implementation_->held_back, {before, after}, implementation_->contacts);
  return implementation_->with_pairs();
}

FreeSpace::Truncation FreeSpace::truncate(const Points& before, Points& after, const Relax& relax) {
  Truncation truncation;
  if (!implementation_->set.obstacles().empty()) truncation = implementation_->truncate(before, after, relax);
  if (implementation_->pairs_began) implementation_->keep_apart(before, after, truncation);
  return truncation;
}

// What found no free place is not safe to go on from.
FreeSpace::Truncation FreeSpace::Implementation::truncate(const Points& before, Points& after, const Relax& relax) {
  Points target = after;
  Truncation truncation = place_all({before, target}, after);
  if (truncation.truncated == 0 || !relax) return truncation;
  for (Points safe = after; truncation.squeezed == 0 && relax(after); safe = after) {
    target = after;
    truncation = place_all({safe, target, true}, after);
  }
  return truncation;
}

FreeSpace::Truncation FreeSpace::Implementation::place_all(const Way& way, Points& after) {
  zones.follow(way);
  std::vector<Index> particles = movable(zones.restless(), way);
  Outcomes outcomes = place_with_fresh_zones(particles, way, after);
  if (set.moves() && !way.obstacles_rest && count(outcomes, Outcome::squeezed) > 0) {
    add_free(all_movable(way), particles, outcomes);
    carry_squeezed(zones, particles, way.from, after, outcomes);
    if (count(outcomes, Outcome::squeezed) > 0) {
      outcomes =
          place_in_parts(environment, way, after, [&](const Way& part, Points& x) { return place_part(particles, part, x); });
    }
  }
  look_at_pins(after);
  return lead_on(particles, outcomes, way, after);
}

// Pins ask nobody: whether they took an element through an obstacle is seen where they are.
void FreeSpace::Implementation::look_at_pins(const Points& after) {
  std::vector<Index> leaving;
  for (Index i = 0; i < static_cast<Index>(after.cols()); ++i) {
    if (surface.pinned[at(i)] != 0 && after.col(i).allFinite() && !zones.allow(i, after.col(i))) leaving.push_back(i);
  }
  if (!leaving.empty()) zones.renew_around(leaving, {after, after, true});
}

FreeSpace::Truncation FreeSpace::Implementation::lead_on(const std::vector<Index>& particles, const Outcomes& outcomes,
                                                         const Way& way, Points& after) {
  std::vector<Index> stopped;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::stopped) stopped.push_back(particles[n]);
  }
  held_back = stopped;
  Truncation truncation;
  truncation.truncated = count(outcomes, Outcome::squeezed) + static_cast<Index>(stopped.size());
  truncation.squeezed = count(outcomes, Outcome::squeezed) + crossed(particles, outcomes);
  std::erase_if(stopped, [&](Index i) { return !can_go_on(i, way.from, way.to, after); });
  for (int round = 1; round < kRounds && !stopped.empty(); ++round) truncation.truncated -= go_on(stopped, way.to, after);
  return truncation;
}

bool FreeSpace::Implementation::can_go_on(Index i, const Points& from, const Points& target, const Points& now) {
  const double way = (target.col(i) - from.col(i)).norm();
  return (now.col(i) - from.col(i)).norm() > kWorthwhile * way && (target.col(i) - now.col(i)).norm() <= kMostLeft * way;
}

Index FreeSpace::Implementation::crossed(const std::vector<Index>& particles, const Outcomes& outcomes) const {
  if (!zones.crosses()) return 0;
  Index found = 0;
  for (Index i = 0; i < static_cast<Index>(surface.pinned.size()); ++i) found += zones.is_crossed(i) ? 1 : 0;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] == Outcome::squeezed && zones.is_crossed(particles[n])) --found;
  }
  return found;
}

std::vector<Index> FreeSpace::Implementation::movable(std::vector<Index> particles, const Way& way) const {
  std::erase_if(particles,
                [&](Index i) { return surface.pinned[at(i)] != 0 || !way.from.col(i).allFinite() || !way.to.col(i).allFinite(); });
  return particles;
}

std::vector<Index> FreeSpace::Implementation::all_movable(const Way& way) const {
  std::vector<Index> particles(at(static_cast<Index>(way.to.cols())));
  std::iota(particles.begin(), particles.end(), 0);
  return movable(std::move(particles), way);
}

Outcomes FreeSpace::Implementation::place_part(std::vector<Index>& particles, const Way& part, Points& after) {
  zones.follow(part);
  Outcomes outcomes = place_with_fresh_zones(particles, part, after);
  carry_squeezed(zones, particles, part.from, after, outcomes);
  return outcomes;
}

// A zone ends where it meets the obstacle's tangent; from there a new one leads round the obstacle.
Index FreeSpace::Implementation::go_on(std::vector<Index>& stopped, const Points& target, Points& after) {
  const Points from = after;
  const Way way{from, target, true};
  zones.renew_around(stopped, way);
  const Outcomes outcomes = place(zones, stopped, way, after);
  std::vector<Index> still;
  for (std::size_t n = 0; n < stopped.size(); ++n) {
    if (outcomes[n] != Outcome::free && can_go_on(stopped[n], from, target, after)) still.push_back(stopped[n]);
  }
  stopped = std::move(still);
  return count(outcomes, Outcome::free);
}

// Zones that were made some steps ago may stop a particle, or leave it no place at all, where new ones would not. Those are their
// neighbours' too.
Outcomes FreeSpace::Implementation::place_with_fresh_zones(std::vector<Index>& particles, const Way& way, Points& positions) {
  Outcomes outcomes = place(zones, particles, way, positions);
  std::vector<Index> stopped;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (outcomes[n] != Outcome::free) stopped.push_back(particles[n]);
  }
  if (stopped.empty()) return outcomes;
  zones.renew_around(stopped, way);
  const std::vector<Index> restless = movable(zones.restless(), way);
  std::vector<Index> all;
  std::set_union(particles.begin(), particles.end(), restless.begin(), restless.end(), std::back_inserter(all));
  particles = std::move(all);
  return place(zones, particles, way, positions);
}

const std::vector<Contact>& FreeSpace::Implementation::with_pairs() {
  contacts.insert(contacts.end(), pair_contacts.begin(), pair_contacts.end());
  return contacts;
}

void FreeSpace::Implementation::begin_pairs(const Points& before, const Points& after) {
  pair_contacts.clear();
  pairs_began = before.allFinite() && after.allFinite();
  if (pairs_began) pairs->begin_step(before, after, pair_contacts);
}

void FreeSpace::Implementation::keep_apart(const Points& before, Points& after, Truncation& truncation) {
  pairs_began = false;
  if (!after.allFinite()) return;
  std::vector<Index> particles = all_movable({before, after});
  const Points allowed = after;
  Outcomes outcomes = PairPlacement(zones, *pairs, particles).place(before, after);
  if (set.moves() && count(outcomes, Outcome::squeezed) > 0) {
    outcomes = place_in_parts(environment, {before, allowed}, after, [&](const Way& part, Points& x) {
      zones.renew_around(particles, part);
      const Outcomes among_obstacles = place_part(particles, part, x);
      pairs->begin_part(part.from, x);
      Outcomes of_part = PairPlacement(zones, *pairs, particles).place(part.from, x);
      keep_squeezed(among_obstacles, of_part);
      return of_part;
    });
  }
  truncation.truncated += static_cast<Index>(outcomes.size()) - count(outcomes, Outcome::free);
  truncation.squeezed += count(outcomes, Outcome::squeezed);
}

}  // namespace sprung
