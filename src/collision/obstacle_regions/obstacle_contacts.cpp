#include "base/machine/kernel.h"
#include "base/machine/simd.h"
#include "base/parallel.h"
#include "collision/core/contact.h"
#include "collision/obstacle_regions/obstacle_safe_regions.h"
#include "collision/obstacles/obstacle_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprung {

namespace {

constexpr Index kPatchChunk = 4;

// A closest point with this weight of a corner is the contact of that particle itself.
constexpr double kAtCorner = 1.0 - 1.0e-6;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The largest displacement [m]; ignores values that are not a number.
SPRUNG_KERNEL double largest_motion(const StepPaths& paths, const std::vector<Index>& particles) {
  double largest = 0.0;
  for (const Index i : particles) {
    const double* from = paths.from.data() + 3 * static_cast<std::ptrdiff_t>(i);
    const double* to = paths.to.data() + 3 * static_cast<std::ptrdiff_t>(i);
    const double squared =
        (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]) + (to[2] - from[2]) * (to[2] - from[2]);
    largest = largest < squared ? squared : largest;
  }
  return std::sqrt(largest);
}

}  // namespace

void ObstacleSafeRegions::find_contacts(const StepPaths& paths, std::vector<Contact>& contacts) {
  std::vector<Index> all(patches_.size());
  std::iota(all.begin(), all.end(), Index{0});
  find_contacts_of(all, paths, contacts);
}

FreshContacts ObstacleSafeRegions::find_contacts_around(const std::vector<Index>& particles, const StepPaths& paths) {
  FreshContacts fresh{.patches = patches_around(particles)};
  find_contacts_of(fresh.patches, paths, fresh.contacts);
  return fresh;
}

void ObstacleSafeRegions::find_contacts_of(const std::vector<Index>& patches, const StepPaths& paths,
                                           std::vector<Contact>& contacts) {
  const double by_obstacles = paths.at_end ? 0.0 : paths.obstacles.max_displacement(paths.from);
  parallel_chunks(static_cast<Index>(patches.size()), kPatchChunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index p = patches[at(k)];
      Patch& patch = patches_[at(p)];
      patch.contacts.clear();
      if (patch.regions.empty() || patch.is_at_rest) continue;
      const double motion = by_obstacles + largest_motion(paths, particles_of(p));
      for (PatchSafeRegions& regions : patch.regions) {
        const RegionDemand demanded = demand(patch, regions.obstacle(), paths);
        const double margin = std::min(margin_, margin_of_step(demanded.gap, motion));
        const double spread = paths.obstacles.shape(regions.obstacle()).largest_displacement();
        append_particle_contacts(p, regions, paths, margin, std::max(motion, demanded.gap + margin + spread));
        append_element_contacts(p, regions, paths, demanded, margin);
      }
      for (Contact& contact : patch.contacts) contact.patch = p;
    }
  });
  for (const Index p : patches) {
    const std::vector<Contact>& found = patches_[at(p)].contacts;
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
}

// A particle of several patches belongs to the first. A path that is not longer than the distance of its end from the surface has
// not crossed it.
void ObstacleSafeRegions::append_particle_contacts(Index p, PatchSafeRegions& regions, const StepPaths& paths, double margin,
                                                   double reach) {
  const Index k = regions.obstacle();
  Patch& patch = patches_[at(p)];
  const std::vector<Index>& particles = particles_of(p);
  regions.find_close({paths.to, particles, paths.obstacles.into_after(k)}, reach, patch.close);
  for (const Index slot : patch.close) {
    const Index i = particles[at(slot)];
    if (patch.own[at(slot)] == 0 || is_permitted(k, i)) continue;
    const Vector3 from = paths.from.col(i);
    const Vector3 to = paths.to.col(i);
    if (!from.allFinite() || !to.allFinite()) continue;
    const auto contact = find_contact(paths.obstacles, k, {i, from, to, surface_.thickness[i], margin}, &regions.memory(slot));
    if (contact) patch.contacts.push_back(*contact);
  }
}

void ObstacleSafeRegions::append_element_contacts(Index p, PatchSafeRegions& regions, const StepPaths& paths,
                                                  const RegionDemand& demand, double margin) {
  const Index k = regions.obstacle();
  const RigidTransform& pose = paths.obstacles.after(k);
  const ElementPatch& patch = surface_.patches[at(p)];
  const PatchPaths local = patch_paths(p, k, paths);
  for (const Index e : regions.near_elements()) {
    if (regions.region(e).broken) continue;
    const SafeRegion& region = regions.renew_closest_points(paths.obstacles.shape(k), patches_[at(p)].topology, local, demand, e);
    if (region.weights.maxCoeff() > kAtCorner) continue;
    const Element& element = surface_.elements[at(patch.first_element + e)];
    Vector3 sum = Vector3::Zero();
    double thickness = 0.0;
    for (std::size_t c = 0; c < at(element.corners); ++c) {
      const Index i = element.particles[c];
      thickness = std::max(thickness, surface_.thickness[i]);
      if (region.weights[static_cast<Index>(c)] != 0.0) sum += region.weights[static_cast<Index>(c)] * paths.to.col(i);
    }
    const Vector3 point = pose * region.point;
    const Vector3 normal = pose.linear() * region.normal;
    const double distance = normal.dot(sum - point);
    const double clearance = paths.obstacles.clearance(k, sum, sum);
    const double gap = std::max(thickness + paths.obstacles.obstacle(k).material.thickness, clearance);
    const auto corners = corners_of(element);
    const auto may_cross = [&](Index i) { return is_permitted(k, i); };
    if (!(distance < gap + margin) || std::any_of(corners.begin(), corners.end(), may_cross)) continue;
    Contact& contact = patches_[at(p)].contacts.emplace_back();
    contact.obstacle = k;
    contact.point = point;
    contact.normal = normal;
    contact.drift = pose.linear() * region.drift;
    contact.distance = distance;
    contact.clearance = clearance;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const double weight = region.weights[static_cast<Index>(c)];
      if (weight == 0.0) continue;
      contact.particles[at(contact.count)] = corners[c];
      contact.weights[at(contact.count++)] = weight;
    }
  }
}

}  // namespace sprung
