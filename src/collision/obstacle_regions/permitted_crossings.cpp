#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include <algorithm>

namespace sprung {

namespace {

// A pin pulls a crossed element through the obstacle if an edge is longer than this multiple of its rest length.
constexpr double kOverstretched = 1.1;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

bool ObstacleSafeRegions::any_crossed() const {
  return std::any_of(patches_.begin(), patches_.end(), [](const Patch& patch) {
    return std::any_of(patch.regions.begin(), patch.regions.end(),
                       [](const PatchSafeRegions& regions) { return regions.any_crossed(); });
  });
}

bool ObstacleSafeRegions::is_crossed(Index particle) const {
  const auto slots = slots_of(particle);
  return std::any_of(slots.begin(), slots.end(), [&](const PatchSlot& entry) {
    const std::vector<PatchSafeRegions>& regions = patches_[at(entry.patch)].regions;
    return std::any_of(regions.begin(), regions.end(),
                       [&](const PatchSafeRegions& of_obstacle) { return of_obstacle.is_crossed(entry.slot); });
  });
}

// A pin may pull an element through an obstacle that then moves the element's other corners for ever. The crossing is permitted,
// and so are those of the elements that these corners pull through in turn.
void ObstacleSafeRegions::permit_crossings(const Points& from) {
  PermittedCrossings permitted;
  for (Index p = 0; p < static_cast<Index>(patches_.size()); ++p) {
    for (const PatchSafeRegions& regions : patches_[at(p)].regions) {
      if (regions.any_crossed()) append_permitted(p, regions, from, permitted);
    }
  }
  set_permitted(std::move(permitted));
}

void ObstacleSafeRegions::set_permitted(PermittedCrossings crossings) {
  for (const auto& [k, i] : permitted_crossings_) permitted_[at(k)][at(i)] = 0;
  for (const auto& [k, i] : crossings) permitted_[at(k)][at(i)] = 1;
  permitted_crossings_ = std::move(crossings);
}

void ObstacleSafeRegions::roll_back(const PermittedCrossings& permitted) {
  for (Patch& patch : patches_) {
    patch.regions.clear();
    patch.known.setEmpty();
  }
  set_permitted(permitted);
}

void ObstacleSafeRegions::append_permitted(Index p, const PatchSafeRegions& regions, const Points& from,
                                           PermittedCrossings& permitted) const {
  const Index k = regions.obstacle();
  for (Index e = 0; e < patches_[at(p)].topology.element_count(); ++e) {
    if (!regions.region(e).broken) continue;
    const Element& element = surface_.elements[at(surface_.patches[at(p)].first_element + e)];
    const bool pulled = is_overstretched(element, from);
    for (std::size_t c = 0; c < at(element.corners); ++c) {
      if (pulled || is_permitted(k, element.particles[c])) permitted.push_back({k, element.particles[c]});
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
