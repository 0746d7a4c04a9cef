#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include "base/parallel.h"
#include "base/sort_unique.h"
#include "collision/core/block_bounds.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr Index kPatchChunk = 4;

// Contact may push particles out of the box around their patch's paths, by this fraction of its diagonal. Farther ones are clipped.
constexpr double kDetour = 0.125;

// If no obstacle moves, the broad phase is queried with a box that is larger by this fraction of the diagonal, so that queries are
// rarer.
constexpr double kReserve = 0.25;

// A pin pulls a crossed element through the obstacle if an edge is longer than this multiple of its rest length.
constexpr double kOverstretched = 1.1;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

ObstacleSafeRegions::ObstacleSafeRegions(const ObstacleSet& set, const CollisionSurface& surface, const Points& rest, double margin)
    : surface_(surface),
      margin_(margin),
      rest_(rest),
      permitted_(set.obstacles().size(), std::vector<char>(surface.motions.size(), 0)) {
  for (std::size_t p = 0; p < surface.patches.size(); ++p) {
    const ElementPatch& elements = surface.patches[p];
    Patch patch{.topology = PatchTopology(surface, elements)};
    const Element& first = surface.elements[at(elements.first_element)];
    patch.size = surface.element_size[at(first.body)];
    for (std::size_t slot = 0; slot < elements.particles.size(); ++slot) {
      const Index i = elements.particles[slot];
      patch.thickness = std::max(patch.thickness, surface.thickness[i]);
      patch.own.push_back(at(slots_of(i).front().patch) == p ? 1 : 0);
    }
    patches_.push_back(std::move(patch));
  }
  find_fixed();
}

void ObstacleSafeRegions::find_fixed() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const ElementPatch& elements = surface_.patches[p];
    patches_[p].fixed = std::ranges::all_of(elements.particles, [&](Index i) { return is_fixed(surface_.motions, i); });
  }
}

void ObstacleSafeRegions::update(const StepPaths& paths) {
  const ObstacleFrame& obstacles = paths.obstacles;
  if (obstacles.set().empty()) return;
  const double max_displacement = paths.at_end ? 0.0 : obstacles.max_displacement(paths.from);
  parallel_chunks(static_cast<Index>(patches_.size()), kPatchChunk, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) {
      Patch& patch = patches_[at(p)];
      patch.leaving.clear();
      patch.is_at_rest = stands_still(p, paths);
      if (patch.is_at_rest) continue;
      find_near(p, paths, max_displacement);
      for (PatchSafeRegions& regions : patch.regions) {
        const ObstacleShape& shape = obstacles.shape(regions.obstacle());
        if (!regions.find_leaving(shape, {paths.to, particles_of(p), obstacles.into_after(regions.obstacle())})) continue;
        regions.update(shape, patch.topology, patch_paths(p, regions.obstacle(), paths), demand(patch, regions.obstacle(), paths));
        append_leaving(p, regions);
      }
    }
  });
}

bool ObstacleSafeRegions::stands_still(Index p, const StepPaths& paths) const {
  const Patch& patch = patches_[at(p)];
  return !paths.obstacles.set().moves() && patch.fixed && !patch.known.isEmpty() &&
         std::ranges::all_of(particles_of(p), [&](Index i) { return paths.from.col(i) == paths.to.col(i); });
}

bool ObstacleSafeRegions::is_at_rest(Index particle) const {
  return std::ranges::all_of(slots_of(particle), [&](const PatchSlot& entry) { return patches_[at(entry.patch)].is_at_rest; });
}

void ObstacleSafeRegions::find_near(Index p, const StepPaths& paths, double max_displacement) {
  Patch& patch = patches_[at(p)];
  const std::vector<Index>& particles = particles_of(p);
  patch.box = finite_bounds(paths.from, particles).merged(finite_bounds(paths.to, particles));
  std::vector<Index> near;
  if (!patch.box.isEmpty()) {
    const double gap = std::max(patch.thickness + paths.obstacles.set().max_thickness(), paths.obstacles.max_clearance(patch.box));
    // Twice, because in the frame of an approaching obstacle the path is longer by its motion, and another obstacle may move the
    // particle.
    const double detour = kDetour * patch.box.diagonal().norm();
    const double reach = gap + margin_ + 2.0 * max_displacement + detour;
    if (!paths.obstacles.set().moves() && patch.known.contains(grown(patch.box, reach))) return;
    patch.known = grown(patch.box, reach + kReserve * patch.box.diagonal().norm());
    paths.obstacles.find_near(patch.known, near);
  }
  if (std::equal(near.begin(), near.end(), patch.regions.begin(), patch.regions.end(),
                 [](Index k, const PatchSafeRegions& regions) { return k == regions.obstacle(); })) {
    return;
  }
  std::vector<PatchSafeRegions> regions;
  for (const Index k : near) {
    const auto kept = std::find_if(patch.regions.begin(), patch.regions.end(),
                                   [k](const PatchSafeRegions& candidate) { return candidate.obstacle() == k; });
    if (kept == patch.regions.end()) {
      regions.emplace_back(k, patch.topology);
    } else {
      regions.push_back(std::move(*kept));
    }
  }
  patch.regions = std::move(regions);
}

void ObstacleSafeRegions::append_leaving(Index p, const PatchSafeRegions& regions) {
  for (const Index slot : regions.leaving()) patches_[at(p)].leaving.push_back(particles_of(p)[at(slot)]);
}

std::vector<Index> ObstacleSafeRegions::leaving() const {
  std::vector<Index> particles;
  for (const Patch& patch : patches_) particles.insert(particles.end(), patch.leaving.begin(), patch.leaving.end());
  sort_unique(particles);
  return particles;
}

PatchPaths ObstacleSafeRegions::patch_paths(Index p, Index k, const StepPaths& paths) const {
  const RigidTransform& into_after = paths.obstacles.into_after(k);
  const RigidTransform& before = paths.at_end ? into_after : paths.obstacles.into_before(k);
  return {{paths.from, particles_of(p), before}, {paths.to, particles_of(p), into_after}};
}

RegionDemand ObstacleSafeRegions::demand(const Patch& patch, Index k, const StepPaths& paths) const {
  RegionDemand demand{.size = patch.size,
                      .gap = patch.thickness + paths.obstacles.obstacle(k).material.thickness,
                      .margin = margin_,
                      .at_end = paths.at_end};
  demand.clearance = patch.box.isEmpty() ? 0.0 : paths.obstacles.clearance(k, patch.box.min(), patch.box.max());
  demand.gap = std::max(demand.gap, demand.clearance);
  return demand;
}

void ObstacleSafeRegions::renew_around(const std::vector<Index>& particles, const StepPaths& paths) {
  const std::vector<Index> around = patches_around(particles);
  std::vector<std::vector<Index>> slots(around.size());
  for (const Index i : particles) {
    for (const PatchSlot& entry : slots_of(i)) {
      const auto k = std::lower_bound(around.begin(), around.end(), entry.patch) - around.begin();
      slots[static_cast<std::size_t>(k)].push_back(entry.slot);
    }
  }
  parallel_chunks(static_cast<Index>(around.size()), kPatchChunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index p = around[at(k)];
      for (PatchSafeRegions& regions : patches_[at(p)].regions) {
        const ObstacleShape& shape = paths.obstacles.shape(regions.obstacle());
        const RegionDemand demanded = demand(patches_[at(p)], regions.obstacle(), paths);
        regions.renew(shape, patches_[at(p)].topology, patch_paths(p, regions.obstacle(), paths), demanded, slots[at(k)]);
        regions.find_leaving(shape, {paths.to, particles_of(p), paths.obstacles.into_after(regions.obstacle())});
        append_leaving(p, regions);
      }
    }
  });
}

bool ObstacleSafeRegions::allow(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const {
  for (const auto& [p, slot] : slots_of(particle)) {
    const Patch& patch = patches_[at(p)];
    if (!patch.known.isEmpty() && !patch.known.contains(position)) return false;
    for (const PatchSafeRegions& regions : patch.regions) {
      if (!is_permitted(regions.obstacle(), particle) && !regions.allow(slot, obstacles.local(regions.obstacle(), position)))
        return false;
    }
  }
  return true;
}

bool ObstacleSafeRegions::planes_allow(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const {
  return std::ranges::all_of(slots_of(particle), [&](const PatchSlot& entry) {
    return std::ranges::all_of(patches_[at(entry.patch)].regions, [&](const PatchSafeRegions& regions) {
      return is_permitted(regions.obstacle(), particle) ||
             regions.planes_allow(entry.slot, obstacles.local(regions.obstacle(), position));
    });
  });
}

void ObstacleSafeRegions::append_half_spaces(const ObstacleFrame& obstacles, Index particle,
                                             std::vector<HalfSpace>& half_spaces) const {
  for (const auto& [p, slot] : slots_of(particle)) {
    const Patch& patch = patches_[at(p)];
    for (int axis = 0; axis < 3 && !patch.known.isEmpty(); ++axis) {
      half_spaces.push_back({Vector3::Unit(axis), patch.known.min()[axis]});
      half_spaces.push_back({-Vector3::Unit(axis), -patch.known.max()[axis]});
    }
    for (const PatchSafeRegions& regions : patch.regions) {
      if (is_permitted(regions.obstacle(), particle)) continue;
      regions.append_half_spaces(slot, obstacles.after(regions.obstacle()), half_spaces);
    }
  }
}

std::vector<Index> ObstacleSafeRegions::patches_around(const std::vector<Index>& particles) const {
  std::vector<Index> around;
  for (const Index i : particles) {
    for (const PatchSlot& entry : slots_of(i)) around.push_back(entry.patch);
  }
  sort_unique(around);
  return around;
}

std::span<const PatchSlot> ObstacleSafeRegions::slots_of(Index particle) const {
  const auto begin = at(surface_.first_slot[at(particle)]);
  return {surface_.slots.data() + begin, at(surface_.first_slot[at(particle) + 1]) - begin};
}

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

void ObstacleSafeRegions::save(ByteWriter& to) const {
  for (const Patch& patch : patches_) {
    to.write(patch.known);
    to.write(patch.box);
    to.write(patch.is_at_rest);
    to.write(patch.regions.size());
    for (const PatchSafeRegions& regions : patch.regions) {
      to.write(regions.obstacle());
      to.write(regions);
    }
  }
}

void ObstacleSafeRegions::load(BinaryReader& from) {
  for (Patch& patch : patches_) {
    std::size_t count = 0;
    from.read(patch.known);
    from.read(patch.box);
    from.read(patch.is_at_rest);
    from.read(count);
    if (count > permitted_.size()) throw BytesError();
    patch.regions.clear();
    for (std::size_t r = 0; r < count; ++r) {
      Index obstacle = 0;
      from.read(obstacle);
      if (obstacle < 0 || at(obstacle) >= permitted_.size()) throw BytesError();
      from.read(patch.regions.emplace_back(obstacle, patch.topology));
    }
  }
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
