#include "collision/impact_zones/pair_separation.h"

#include "collision/pairs/contact_stencil.h"
#include "collision/pairs/element_contacts.h"

#include <algorithm>

namespace sprung {

namespace {

// Constrained sides keep this fraction of the smallest thickness between them. The rest is room to move.
constexpr double kKeptFraction = 0.125;

}  // namespace

PairSeparation::PairSeparation(const CollisionSurface& surface, const Points& rest, double margin)
    : surface_(surface), list_(surface, rest, margin) {}

std::span<const DivisionPlanes::Bound> PairSeparation::bounds_of(Index particle) const {
  const auto range = std::equal_range(bounds_.begin(), bounds_.end(), DivisionPlanes::Bound{.particle = particle, .half_space = {}},
                                      [](const auto& a, const auto& b) { return a.particle < b.particle; });
  return {range.first, range.second};
}

Index PairSeparation::body_at(Index particle) const {
  return surface_.elements[static_cast<std::size_t>(list_.topology().elements_at(particle).front())].body;
}

void PairSeparation::begin_step(const Points& before, const Points& after, std::vector<Contact>& contacts) {
  list_.begin_step(before, after);
  append_self_contacts(surface_, list_.topology(), list_.candidates(), before, after, contacts);
}

void PairSeparation::forget() {
  list_.forget();
  rotated_ = false;
}

void PairSeparation::begin_substep(const Points& before, const Points& after) { list_.begin_substep(before, after); }

const std::vector<Index>& PairSeparation::constrain(const Points& before, const Points& targets,
                                                    const ParticleDisplacements& displacements) {
  DivisionPlanes planes(before, targets, surface_.motions, displacements, kKeptFraction * surface_.thickness.minCoeff());
  list_.follow(before, targets);
  if (rotated_) planes.renew_normals(list_.pairs());
  while (planes.constrain(list_.pairs())) list_.follow(before, planes.ends());
  rotated_ = planes.rotates();
  ends_ = planes.ends();
  constrained_ = planes.constrained();
  std::sort(constrained_.begin(), constrained_.end());
  crossing_ = planes.crossing();
  std::sort(crossing_.begin(), crossing_.end());
  bounds_ = planes.bounds(list_.pairs());
  moved_with_obstacle_ = planes.moved_with_obstacle();
  return constrained_;
}

Vector3 PairSeparation::safe_position(Index particle) const { return ends_.col(particle); }

void PairSeparation::append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const {
  for (const DivisionPlanes::Bound& bound : bounds_of(particle)) half_spaces.push_back(bound.half_space);
}

PairSeparation::Sphere PairSeparation::sphere(Index particle) const {
  const VertexBounds& spheres = list_.spheres();
  return {spheres.center(particle, 1.0), spheres.radius(particle)};
}

const std::vector<Index>& PairSeparation::moved_with_obstacle() const { return moved_with_obstacle_; }

bool PairSeparation::crosses(Index particle) const { return std::binary_search(crossing_.begin(), crossing_.end(), particle); }

std::vector<Index> PairSeparation::crossing_fixed() const {
  const auto is_driven = [&](Index i) { return surface_.motions[static_cast<std::size_t>(i)] == ParticleMotion::driven; };
  std::vector<Index> fixed;
  for (const Index i : crossing_) {
    if (!is_fixed(surface_.motions, i) || (!fixed.empty() && fixed.back() == i)) continue;
    const auto elements = list_.topology().elements_at(i);
    const bool driven_as_a_whole = std::ranges::all_of(elements, [&](Index e) {
      return std::ranges::all_of(corners_of(surface_.elements[static_cast<std::size_t>(e)]), is_driven);
    });
    if (!driven_as_a_whole) fixed.push_back(i);
  }
  return fixed;
}

bool PairSeparation::allows(Index particle, const Vector3& p) const {
  if (!list_.spheres().contains(particle, p, 1.0)) return false;
  const auto bounds = bounds_of(particle);
  return std::all_of(bounds.begin(), bounds.end(),
                     [&](const DivisionPlanes::Bound& bound) { return bound.half_space.normal.dot(p) >= bound.half_space.offset; });
}

void PairSeparation::append_closest_contacts(const Points& before, std::vector<Contact>& contacts) {
  const auto is_constrained = [&](Index i) { return std::binary_search(constrained_.begin(), constrained_.end(), i); };
  for (const ContactStencil& pair : list_.pairs()) {
    const std::span particles(pair.particles.data(), static_cast<std::size_t>(pair.count()));
    const bool within_a_body = body_at(particles.front()) == body_at(particles.back());
    if (within_a_body || std::ranges::none_of(particles, is_constrained)) continue;
    if (const auto contact = closest_contact(pair, before)) contacts.push_back(*contact);
  }
}

}  // namespace sprung
