#include "collision/impact_zones/pair_separation.h"

#include "collision/impact_zones/division_planes.h"
#include "collision/pairs/contact_stencil.h"
#include "collision/pairs/element_contacts.h"
#include "collision/pairs/neighbour_list.h"

#include <algorithm>

namespace sprung {

namespace {

// Sides that are held keep this part of the least thickness between them: the rest is left to their way.
constexpr double kKeptPart = 0.125;

}  // namespace

struct PairSeparation::Implementation {
  Implementation(const CollisionSurface& own, const Points& rest, double margin) : surface(own), watch(own, rest, margin) {}

  [[nodiscard]] std::span<const DivisionPlanes::Bound> bounds_of(Index particle) const {
    const auto range = std::equal_range(bounds.begin(), bounds.end(), DivisionPlanes::Bound{.particle = particle, .half_space = {}},
                                        [](const auto& a, const auto& b) { return a.particle < b.particle; });
    return {range.first, range.second};
  }

  [[nodiscard]] Index body_at(Index particle) {
    return surface.elements[static_cast<std::size_t>(watch.features().elements_at(particle).front())].body;
  }

  const CollisionSurface& surface;
  NeighbourList watch;
  Points ends;
  std::vector<Index> held;
  std::vector<Index> passing;  ///< ascending
  std::vector<DivisionPlanes::Bound> bounds;
  std::vector<Index> taken_along;
  bool turned = false;  ///< groups were, and the normals of their pairs not
};

PairSeparation::PairSeparation(const CollisionSurface& surface, const Points& rest, double margin)
    : implementation_(new Implementation(surface, rest, margin)) {}
PairSeparation::~PairSeparation() = default;
PairSeparation::PairSeparation(PairSeparation&&) noexcept = default;
PairSeparation& PairSeparation::operator=(PairSeparation&&) noexcept = default;

void PairSeparation::begin_step(const Points& before, const Points& after, std::vector<Contact>& contacts) {
  Implementation& self = *implementation_;
  self.watch.begin_step(before, after);
  append_self_contacts(self.surface, self.watch.features(), self.watch.candidates(), before, after, contacts);
}

void PairSeparation::forget() { implementation_->watch.forget(); }

void PairSeparation::begin_part(const Points& before, const Points& after) { implementation_->watch.begin_part(before, after); }

const std::vector<Index>& PairSeparation::hold(const Points& before, const Points& targets, const ParticleDisplacements& carriers) {
  Implementation& self = *implementation_;
  DivisionPlanes planes(before, targets, self.surface.pinned, carriers, kKeptPart * self.surface.thickness.minCoeff());
  self.watch.follow(before, targets);
  if (self.turned) planes.renew_normals(self.watch.pairs());
  while (planes.hold(self.watch.pairs())) self.watch.follow(before, planes.ends());
  while (!planes.passing().empty() && planes.give_way(self.watch.pairs())) self.watch.follow(before, planes.ends());
  self.turned = planes.turns();
  self.ends = planes.ends();
  self.held = planes.held();
  std::sort(self.held.begin(), self.held.end());
  self.passing = planes.passing();
  std::sort(self.passing.begin(), self.passing.end());
  self.bounds = planes.bounds(self.watch.pairs());
  self.taken_along = planes.taken_along();
  return self.held;
}

Vector3 PairSeparation::safe_place(Index particle) const { return implementation_->ends.col(particle); }

void PairSeparation::append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const {
  for (const DivisionPlanes::Bound& bound : implementation_->bounds_of(particle)) half_spaces.push_back(bound.half_space);
}

PairSeparation::Ball PairSeparation::ball(Index particle) const {
  const VertexBounds& balls = implementation_->watch.balls();
  return {balls.center(particle, 1.0), balls.radius(particle)};
}

const std::vector<Index>& PairSeparation::taken_along() const { return implementation_->taken_along; }

bool PairSeparation::passes(Index particle) const {
  return std::binary_search(implementation_->passing.begin(), implementation_->passing.end(), particle);
}

std::vector<Index> PairSeparation::passing_pins() const {
  const CollisionSurface& surface = implementation_->surface;
  const auto is_pinned = [&](Index i) { return surface.pinned[static_cast<std::size_t>(i)] != 0; };
  std::vector<Index> pins;
  for (const Index i : implementation_->passing) {
    if (!is_pinned(i) || (!pins.empty() && pins.back() == i)) continue;
    const auto elements = implementation_->watch.features().elements_at(i);
    const bool draws = std::ranges::any_of(elements, [&](Index e) {
      return !std::ranges::all_of(corners_of(surface.elements[static_cast<std::size_t>(e)]), is_pinned);
    });
    if (draws) pins.push_back(i);
  }
  return pins;
}

bool PairSeparation::allows(Index particle, const Vector3& p) const {
  if (!implementation_->watch.balls().holds(particle, p, 1.0)) return false;
  const auto bounds = implementation_->bounds_of(particle);
  return std::all_of(bounds.begin(), bounds.end(),
                     [&](const DivisionPlanes::Bound& bound) { return bound.half_space.normal.dot(p) >= bound.half_space.offset; });
}

void PairSeparation::append_meetings(const Points& before, std::vector<Contact>& meetings) {
  Implementation& self = *implementation_;
  const auto is_held = [&](Index i) { return std::binary_search(self.held.begin(), self.held.end(), i); };
  for (const ContactStencil& pair : self.watch.pairs()) {
    const std::span particles(pair.particles.data(), static_cast<std::size_t>(pair.count()));
    const bool within_a_body = self.body_at(particles.front()) == self.body_at(particles.back());
    if (within_a_body || std::ranges::none_of(particles, is_held)) continue;
    if (const auto meeting = closest_contact(pair, before)) meetings.push_back(*meeting);
  }
}

NeighbourListCounts PairSeparation::counts() const { return implementation_->watch.counts(); }

}  // namespace sprung
