#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include <algorithm>

namespace sprung {

namespace {

// An element that is crossed and has an edge of more than so many times its length at rest is dragged along.
constexpr double kOverstretched = 1.1;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

bool ObstacleSafeRegions::crosses() const {
  return std::any_of(patches_.begin(), patches_.end(), [](const Patch& patch) {
    return std::any_of(patch.regions.begin(), patch.regions.end(),
                       [](const PatchSafeRegions& regions) { return regions.crosses(); });
  });
}

bool ObstacleSafeRegions::is_crossed(Index particle) const {
  const auto slots = slots_of(particle);
  return std::any_of(slots.begin(), slots.end(), [&](const PatchSlot& place) {
    const std::vector<PatchSafeRegions>& regions = patches_[at(place.patch)].regions;
    return std::any_of(regions.begin(), regions.end(), [&](const PatchSafeRegions& z) { return z.is_crossed(place.slot); });
  });
}

// A pin may take an element through an obstacle, and the obstacle the element's other corners along for ever. They are let through,
// and then what they drag along in turn.
void ObstacleSafeRegions::permit_crossings(const Points& from) {
  PermittedCrossings passing;
  for (Index p = 0; p < static_cast<Index>(patches_.size()); ++p) {
    for (const PatchSafeRegions& regions : patches_[at(p)].regions) {
      if (regions.crosses()) append_passing(p, regions, from, passing);
    }
  }
  set_passing(std::move(passing));
}

void ObstacleSafeRegions::set_passing(PermittedCrossings corners) {
  for (const auto& [k, i] : permitted_crossings_) passing_[at(k)][at(i)] = 0;
  for (const auto& [k, i] : corners) passing_[at(k)][at(i)] = 1;
  permitted_crossings_ = std::move(corners);
}

void ObstacleSafeRegions::roll_back(const PermittedCrossings& permitted) {
  for (Patch& patch : patches_) {
    patch.regions.clear();
    patch.known.setEmpty();
  }
  set_passing(permitted);
}

void ObstacleSafeRegions::append_passing(Index p, const PatchSafeRegions& regions, const Points& from,
                                         PermittedCrossings& passing) const {
  const Index k = regions.obstacle();
  for (Index e = 0; e < patches_[at(p)].topology.element_count(); ++e) {
    if (!regions.region(e).broken) continue;
    const Element& element = surface_.elements[at(surface_.patches[at(p)].first_element + e)];
    const bool dragged = is_overstretched(element, from);
    for (std::size_t c = 0; c < at(element.corners); ++c) {
      if (dragged || is_passing(k, element.particles[c])) passing.push_back({k, element.particles[c]});
    }
  }
}

bool ObstacleSafeRegions::is_overstretched(const Element& element, const Points& positions) const {
  for (std::size_t c = 0; c < at(element.corners); ++c) {
    const Index i = element.particles[c];
    const Index j = element.particles[(c + 1) % at(element.corners)];
    if ((positions.col(i) - positions.col(j)).norm() > kOverstretched * (rest_.col(i) - rest_.col(j)).norm()) return true;
  }
  return false;
}

}  // namespace sprung
