#include "collision/obstacle_regions/obstacle_motion.h"

#include "base/sort_unique.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Sorts by particle and keeps the nearest entry of each.
template <class Corner>
void keep_nearest(std::vector<Corner>& corners) {
  std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.particle != b.particle ? a.particle < b.particle : a.distance < b.distance;
  });
  const auto same = [](const Corner& a, const Corner& b) { return a.particle == b.particle; };
  corners.erase(std::unique(corners.begin(), corners.end(), same), corners.end());
}

}  // namespace

ObstacleMotion::ObstacleMotion(const ObstacleSafeRegions& regions, const ObstacleFrame& obstacles)
    : regions_(regions), obstacles_(obstacles), surface_(regions.surface_) {}

std::vector<ParticleDisplacement> ObstacleMotion::displacements(const Points& from) const {
  std::vector<ParticleDisplacement> particles;
  if (!obstacles_.set().moves()) return particles;
  for (Index i = 0; i < static_cast<Index>(from.cols()); ++i) {
    const Index k = touched_obstacle(i);
    if (k != kNone) particles.push_back({i, obstacles_.moved_position(k, from.col(i)) - from.col(i)});
  }
  return particles;
}

Index ObstacleMotion::touched_obstacle(Index particle) const {
  for (const PatchSlot& entry : regions_.slots_of(particle)) {
    for (const PatchSafeRegions& regions : regions_.patches_[at(entry.patch)].regions) {
      if (regions.may_touch(entry.slot) && !obstacles_.is_at_rest(regions.obstacle())) return regions.obstacle();
    }
  }
  return kNone;
}

BlockedVertex ObstacleMotion::blocked_vertex(Index particle, const Vector3& from, const Vector3& position) const {
  BlockedVertex vertex{.particle = particle};
  for (const PatchSlot& entry : regions_.slots_of(particle)) {
    for (const PatchSafeRegions& regions : regions_.patches_[at(entry.patch)].regions) {
      const Index k = regions.obstacle();
      if (obstacles_.is_at_rest(k) || regions.allow(entry.slot, obstacles_.local(k, position))) continue;
      vertex.obstacle = k;
      vertex.motion = obstacles_.after(k) * obstacles_.before(k).inverse();
      vertex.surface = obstacles_.shape(k).moved_triangle(obstacles_.local_before(k, from));
      if (!vertex.surface) return vertex;
      for (Vector3& corner : vertex.surface->before) corner = obstacles_.before(k) * corner;
      for (Vector3& corner : vertex.surface->after) corner = obstacles_.after(k) * corner;
      return vertex;
    }
  }
  return vertex;
}

std::vector<Index> ObstacleMotion::near_obstacles(Index particle) const {
  std::vector<Index> near;
  for (const PatchSlot& entry : regions_.slots_of(particle)) {
    for (const PatchSafeRegions& regions : regions_.patches_[at(entry.patch)].regions) near.push_back(regions.obstacle());
  }
  sort_unique(near);
  return near;
}

void ObstacleMotion::append_moved(Index particle, const Vector3& from, std::vector<Vector3>& positions) const {
  for (const Index k : near_obstacles(particle)) {
    if (!obstacles_.is_at_rest(k)) positions.push_back(obstacles_.moved_position(k, from));
  }
}

std::optional<Vector3> ObstacleMotion::moved(Index particle, const Vector3& from) const {
  for (const Index k : near_obstacles(particle)) {
    if (obstacles_.is_at_rest(k)) continue;
    const auto moved = obstacles_.shape(k).moved_element({.x = {obstacles_.local_before(k, from)}, .count = 1});
    if (!moved) return std::nullopt;
    const Vector3 position = obstacles_.after(k) * moved->corners.x[0];
    if (!crosses_another(k, particle, from, position)) return position;
  }
  return std::nullopt;
}

// In the frame of an obstacle the particle's path is straight, and starts where that obstacle moves it.
bool ObstacleMotion::crosses_another(Index k, Index particle, const Vector3& from, const Vector3& position) const {
  const std::vector<Index> near = near_obstacles(particle);
  return std::any_of(near.begin(), near.end(), [&](Index other) {
    if (other == k) return false;
    const auto moved = obstacles_.shape(other).moved_element({.x = {obstacles_.local_before(other, from)}, .count = 1});
    return !moved || obstacles_.shape(other).first_crossing(moved->corners.x[0], obstacles_.local(other, position));
  });
}

void ObstacleMotion::append_moved_elements(Index p, const Points& from, std::vector<MovedVertex>& corners) const {
  const ElementPatch& patch = surface_.patches[at(p)];
  for (const PatchSafeRegions& regions : regions_.patches_[at(p)].regions) {
    const Index k = regions.obstacle();
    for (Index e = 0; e < regions_.patches_[at(p)].topology.element_count() && !obstacles_.is_at_rest(k); ++e) {
      if (!regions.region(e).broken) continue;
      const Element& element = surface_.elements[at(patch.first_element + e)];
      ElementCorners local{.count = element.corners};
      for (std::size_t c = 0; c < at(element.corners); ++c) local.x[c] = obstacles_.local_before(k, from.col(element.particles[c]));
      const auto moved = obstacles_.shape(k).moved_element(local);
      for (std::size_t c = 0; c < at(element.corners) && moved; ++c) {
        const Index i = element.particles[c];
        const Vector3 position = obstacles_.after(k) * moved->corners.x[c];
        if (!crosses_another(k, i, from.col(i), position)) corners.push_back({i, moved->distance, position});
      }
    }
  }
}

std::vector<MovedVertex> ObstacleMotion::moved_with_elements(const Points& from) const {
  std::vector<MovedVertex> corners;
  for (Index p = 0; p < static_cast<Index>(regions_.patches_.size()); ++p) append_moved_elements(p, from, corners);
  keep_nearest(corners);
  return corners;
}

void ObstacleMotion::append_pushes(Index p, const PatchSafeRegions& regions, const StepPaths& paths,
                                   std::vector<Push>& pushes) const {
  const PatchTopology& topology = regions_.patches_[at(p)].topology;
  const Index k = regions.obstacle();
  for (Index e = 0; e < topology.element_count(); ++e) {
    const SafeRegion& region = regions.region(e);
    if (region.broken || !std::isfinite(region.distance)) continue;
    const Vector3 normal = obstacles_.before(k).linear() * region.normal;
    const auto corners = corners_of(surface_.elements[at(surface_.patches[at(p)].first_element + e)]);
    double approach = 0.0;
    for (const Index i : corners) {
      if (!is_fixed(surface_.motions, i)) continue;
      approach = std::max(approach, normal.dot(obstacles_.moved_position(k, paths.from.col(i)) - paths.to.col(i)));
    }
    for (const Index i : corners) {
      if (!is_fixed(surface_.motions, i) && approach > 0.0)
        pushes.push_back({i, region.distance, approach * normal, regions_.patches_[at(p)].size});
    }
  }
}

std::vector<Push> ObstacleMotion::pushes_at_pins(const StepPaths& paths) const {
  std::vector<Push> pushes;
  for (Index p = 0; p < static_cast<Index>(regions_.patches_.size()); ++p) {
    for (const PatchSafeRegions& regions : regions_.patches_[at(p)].regions) append_pushes(p, regions, paths, pushes);
  }
  keep_nearest(pushes);
  return pushes;
}

}  // namespace sprung
