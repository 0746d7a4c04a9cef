#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Leaves of each particle's only that of the least distance.
template <class Corner>
void keep_nearest(std::vector<Corner>& corners) {
  std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.particle != b.particle ? a.particle < b.particle : a.distance < b.distance;
  });
  const auto same = [](const Corner& a, const Corner& b) { return a.particle == b.particle; };
  corners.erase(std::unique(corners.begin(), corners.end(), same), corners.end());
}

}  // namespace

std::vector<ParticleDisplacement> ObstacleSafeRegions::carried(const Points& from) const {
  std::vector<ParticleDisplacement> particles;
  if (!set_.moves()) return particles;
  for (Index i = 0; i < static_cast<Index>(from.cols()); ++i) {
    const Index k = leans_on(i);
    if (k != kNone) particles.push_back({i, set_.carried(k, from.col(i)) - from.col(i)});
  }
  return particles;
}

Index ObstacleSafeRegions::leans_on(Index particle) const {
  for (const PatchSlot& place : slots_of(particle)) {
    for (const PatchSafeRegions& regions : patches_[at(place.patch)].regions) {
      if (regions.may_lean(place.slot) && !set_.rests(regions.obstacle())) return regions.obstacle();
    }
  }
  return kNone;
}

KinematicAnchor ObstacleSafeRegions::anchor(Index particle, const Vector3& from, const Vector3& position) const {
  KinematicAnchor anchor{.particle = particle};
  for (const PatchSlot& place : slots_of(particle)) {
    for (const PatchSafeRegions& regions : patches_[at(place.patch)].regions) {
      const Index k = regions.obstacle();
      if (set_.rests(k) || regions.allow(place.slot, set_.local(k, position))) continue;
      anchor.obstacle = k;
      anchor.motion = set_.after(k) * set_.before(k).inverse();
      anchor.surface = set_.shape(k).moved_triangle(set_.local_before(k, from));
      if (!anchor.surface) return anchor;
      for (Vector3& corner : anchor.surface->before) corner = set_.before(k) * corner;
      for (Vector3& corner : anchor.surface->after) corner = set_.after(k) * corner;
      return anchor;
    }
  }
  return anchor;
}

std::vector<Index> ObstacleSafeRegions::near_obstacles(Index particle) const {
  std::vector<Index> near;
  for (const PatchSlot& place : slots_of(particle)) {
    for (const PatchSafeRegions& regions : patches_[at(place.patch)].regions) near.push_back(regions.obstacle());
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

void ObstacleSafeRegions::append_carried(Index particle, const Vector3& from, std::vector<Vector3>& places) const {
  for (const Index k : near_obstacles(particle)) {
    if (!set_.rests(k)) places.push_back(set_.carried(k, from));
  }
}

std::optional<Vector3> ObstacleSafeRegions::carried(Index particle, const Vector3& from) const {
  for (const Index k : near_obstacles(particle)) {
    if (set_.rests(k)) continue;
    const auto carried = set_.shape(k).carried({.x = {set_.local_before(k, from)}, .count = 1}, 0.0);
    if (!carried) return std::nullopt;
    const Vector3 place = set_.after(k) * carried->corners.x[0];
    if (!leads_through_another(k, particle, from, place)) return place;
  }
  return std::nullopt;
}

// Before each obstacle a particle goes straight from where that one carries it.
bool ObstacleSafeRegions::leads_through_another(Index k, Index particle, const Vector3& from, const Vector3& place) const {
  const std::vector<Index> near = near_obstacles(particle);
  return std::any_of(near.begin(), near.end(), [&](Index other) {
    if (other == k) return false;
    const auto carried = set_.shape(other).carried({.x = {set_.local_before(other, from)}, .count = 1}, 0.0);
    return !carried || set_.shape(other).first_crossing(carried->corners.x[0], set_.local(other, place));
  });
}

void ObstacleSafeRegions::append_carried_around(Index p, const Points& from, double lift, std::vector<MovedVertex>& corners) const {
  const ElementPatch& patch = surface_.patches[at(p)];
  for (const PatchSafeRegions& regions : patches_[at(p)].regions) {
    const Index k = regions.obstacle();
    for (Index e = 0; e < patches_[at(p)].topology.element_count() && !set_.rests(k); ++e) {
      if (!regions.region(e).broken) continue;
      const Element& element = surface_.elements[at(patch.first_element + e)];
      ElementCorners local{.count = element.corners};
      for (std::size_t c = 0; c < at(element.corners); ++c) local.x[c] = set_.local_before(k, from.col(element.particles[c]));
      const auto carried = set_.shape(k).carried(local, lift);
      for (std::size_t c = 0; c < at(element.corners) && carried; ++c) {
        const Index i = element.particles[c];
        const Vector3 place = set_.after(k) * carried->corners.x[c];
        if (!leads_through_another(k, i, from.col(i), place)) corners.push_back({i, carried->distance, place});
      }
    }
  }
}

std::vector<MovedVertex> ObstacleSafeRegions::carried_with_elements(const Points& from, double lift) const {
  std::vector<MovedVertex> corners;
  for (Index p = 0; p < static_cast<Index>(patches_.size()); ++p) append_carried_around(p, from, lift, corners);
  keep_nearest(corners);
  return corners;
}

void ObstacleSafeRegions::append_pushes(Index p, const PatchSafeRegions& regions, const Way& way, std::vector<Push>& pushes) const {
  const PatchTopology& topology = patches_[at(p)].topology;
  const Index k = regions.obstacle();
  for (Index e = 0; e < topology.element_count(); ++e) {
    const SafeRegion& region = regions.region(e);
    if (!topology.corners(e).pinned || region.broken || !std::isfinite(region.distance)) continue;
    const Vector3 normal = set_.before(k).linear() * region.normal;
    const auto corners = corners_of(surface_.elements[at(surface_.patches[at(p)].first_element + e)]);
    double nearer = 0.0;
    for (const Index i : corners) {
      if (surface_.pinned[at(i)] == 0) continue;
      nearer = std::max(nearer, normal.dot(set_.carried(k, way.from.col(i)) - way.to.col(i)));
    }
    for (const Index i : corners) {
      if (surface_.pinned[at(i)] == 0 && nearer > 0.0)
        pushes.push_back({i, region.distance, nearer * normal, patches_[at(p)].size});
    }
  }
}

std::vector<Push> ObstacleSafeRegions::pushes_at_pins(const Way& way) const {
  std::vector<Push> pushes;
  for (Index p = 0; p < static_cast<Index>(patches_.size()); ++p) {
    for (const PatchSafeRegions& regions : patches_[at(p)].regions) append_pushes(p, regions, way, pushes);
  }
  keep_nearest(pushes);
  return pushes;
}

}  // namespace sprung
