#include "collision/impact_zones/pair_separation.h"

#include "collision/impact_zones/division_planes.h"
#include "collision/pairs/contact_stencil.h"
#include "collision/pairs/element_contacts.h"
#include "collision/pairs/neighbour_list.h"

#include <algorithm>

namespace sprung {

namespace {

// Constrained sides keep this fraction of the smallest thickness between them. The rest is room to move.
constexpr double kKeptFraction = 0.125;

}  // namespace

struct PairSeparation::Implementation {
  Implementation(const CollisionSurface& own, const Points& rest, double margin) : surface(own), list(own, rest, margin) {}

  [[nodiscard]] std::span<const DivisionPlanes::Bound> bounds_of(Index particle) const {
    const auto range = std::equal_range(bounds.begin(), bounds.end(), DivisionPlanes::Bound{.particle = particle, .half_space = {}},
                                        [](const auto& a, const auto& b) { return a.particle < b.particle; });
    return {range.first, range.second};
  }

  [[nodiscard]] Index body_at(Index particle) {
    return surface.elements[static_cast<std::size_t>(list.topology().elements_at(particle).front())].body;
  }

  const CollisionSurface& surface;
  NeighbourList list;
  Points ends;
  std::vector<Index> constrained;  ///< ascending
  std::vector<Index> passing;      ///< ascending
  std::vector<DivisionPlanes::Bound> bounds;
  std::vector<Index> anchored;
  bool rotated = false;  ///< pairs may have rotated without their normals
};

PairSeparation::PairSeparation(const CollisionSurface& surface, const Points& rest, double margin)
    : implementation_(new Implementation(surface, rest, margin)) {}
PairSeparation::~PairSeparation() = default;
PairSeparation::PairSeparation(PairSeparation&&) noexcept = default;
PairSeparation& PairSeparation::operator=(PairSeparation&&) noexcept = default;

void PairSeparation::begin_step(const Points& before, const Points& after, std::vector<Contact>& contacts) {
  Implementation& self = *implementation_;
  self.list.begin_step(before, after);
  append_self_contacts(self.surface, self.list.topology(), self.list.candidates(), before, after, contacts);
}

void PairSeparation::forget() {
  implementation_->list.forget();
  implementation_->rotated = false;
}

void PairSeparation::begin_substep(const Points& before, const Points& after) {
  implementation_->list.begin_substep(before, after);
}

const std::vector<Index>& PairSeparation::constrain(const Points& before, const Points& targets,
                                                    const ParticleDisplacements& displacements) {
  Implementation& self = *implementation_;
  DivisionPlanes planes(before, targets, self.surface.motions, displacements, kKeptFraction * self.surface.thickness.minCoeff());
  self.list.follow(before, targets);
  if (self.rotated) planes.renew_normals(self.list.pairs());
  while (planes.constrain(self.list.pairs())) self.list.follow(before, planes.ends());
  self.rotated = planes.rotates();
  self.ends = planes.ends();
  self.constrained = planes.constrained();
  std::sort(self.constrained.begin(), self.constrained.end());
  self.passing = planes.passing();
  std::sort(self.passing.begin(), self.passing.end());
  self.bounds = planes.bounds(self.list.pairs());
  self.anchored = planes.anchored();
  return self.constrained;
}

Vector3 PairSeparation::safe_position(Index particle) const { return implementation_->ends.col(particle); }

void PairSeparation::append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const {
  for (const DivisionPlanes::Bound& bound : implementation_->bounds_of(particle)) half_spaces.push_back(bound.half_space);
}

PairSeparation::Sphere PairSeparation::sphere(Index particle) const {
  const VertexBounds& spheres = implementation_->list.spheres();
  return {spheres.center(particle, 1.0), spheres.radius(particle)};
}

const std::vector<Index>& PairSeparation::anchored() const { return implementation_->anchored; }

bool PairSeparation::passes(Index particle) const {
  return std::binary_search(implementation_->passing.begin(), implementation_->passing.end(), particle);
}

std::vector<Index> PairSeparation::passing_fixed() const {
  const CollisionSurface& surface = implementation_->surface;
  const auto is_driven = [&](Index i) { return surface.motions[static_cast<std::size_t>(i)] == ParticleMotion::driven; };
  std::vector<Index> fixed;
  for (const Index i : implementation_->passing) {
    if (!is_fixed(surface.motions, i) || (!fixed.empty() && fixed.back() == i)) continue;
    const auto elements = implementation_->list.topology().elements_at(i);
    const bool driven_as_a_whole = std::ranges::all_of(elements, [&](Index e) {
      return std::ranges::all_of(corners_of(surface.elements[static_cast<std::size_t>(e)]), is_driven);
    });
    if (!driven_as_a_whole) fixed.push_back(i);
  }
  return fixed;
}

bool PairSeparation::allows(Index particle, const Vector3& p) const {
  if (!implementation_->list.spheres().contains(particle, p, 1.0)) return false;
  const auto bounds = implementation_->bounds_of(particle);
  return std::all_of(bounds.begin(), bounds.end(),
                     [&](const DivisionPlanes::Bound& bound) { return bound.half_space.normal.dot(p) >= bound.half_space.offset; });
}

void PairSeparation::append_closest_contacts(const Points& before, std::vector<Contact>& contacts) {
  Implementation& self = *implementation_;
  const auto is_constrained = [&](Index i) { return std::binary_search(self.constrained.begin(), self.constrained.end(), i); };
  for (const ContactStencil& pair : self.list.pairs()) {
    const std::span particles(pair.particles.data(), static_cast<std::size_t>(pair.count()));
    const bool within_a_body = self.body_at(particles.front()) == self.body_at(particles.back());
    if (within_a_body || std::ranges::none_of(particles, is_constrained)) continue;
    if (const auto contact = closest_contact(pair, before)) contacts.push_back(*contact);
  }
}

}  // namespace sprung
