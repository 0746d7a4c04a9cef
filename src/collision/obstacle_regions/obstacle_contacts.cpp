#include "base/kernel.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "collision/obstacle_regions/obstacle_safe_regions.h"
#include "collision/obstacles/vertex_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprung {

namespace {

constexpr Index kPatchChunk = 4;

// A nearest point this close to a corner is that particle's own contact.
constexpr double kAtCorner = 1.0 - 1.0e-6;

// Passes lead particles less far than the forces alone have led those around them in this step. What is farther off than this part
// of the gap, and that part of the way, is no contact: it would not be touched.
constexpr double kMarginOfGap = 0.1;
constexpr double kMarginOfMotion = 0.5;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The longest way [m], but for what is not a number.
SPRUNG_KERNEL double largest_motion(const Way& way, const std::vector<Index>& particles) {
  double largest = 0.0;
  for (const Index i : particles) {
    const double* from = way.from.data() + 3 * static_cast<std::ptrdiff_t>(i);
    const double* to = way.to.data() + 3 * static_cast<std::ptrdiff_t>(i);
    const double squared =
        (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]) + (to[2] - from[2]) * (to[2] - from[2]);
    largest = largest < squared ? squared : largest;
  }
  return std::sqrt(largest);
}

}  // namespace

void ObstacleSafeRegions::find_contacts(const Way& way, std::vector<Contact>& contacts) {
  std::vector<Index> all(patches_.size());
  std::iota(all.begin(), all.end(), Index{0});
  find_contacts_of(all, way, contacts);
}

FreshContacts ObstacleSafeRegions::find_contacts_around(const std::vector<Index>& particles, const Way& way) {
  FreshContacts fresh{.patches = patches_around(particles)};
  find_contacts_of(fresh.patches, way, fresh.contacts);
  return fresh;
}

void ObstacleSafeRegions::find_contacts_of(const std::vector<Index>& patches, const Way& way, std::vector<Contact>& contacts) {
  const double carried = way.obstacles_rest ? 0.0 : set_.carries_at_most(way.from);
  parallel_chunks(static_cast<Index>(patches.size()), kPatchChunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index p = patches[at(k)];
      Patch& patch = patches_[at(p)];
      patch.contacts.clear();
      if (patch.regions.empty()) continue;
      const double motion = carried + largest_motion(way, particles_of(p));
      for (PatchSafeRegions& regions : patch.regions) {
        const RegionDemand demanded = demand(patch, regions.obstacle(), way);
        const double margin = std::min(margin_, kMarginOfGap * demanded.gap + kMarginOfMotion * motion);
        const double spread = set_.shape(regions.obstacle()).largest_displacement();
        append_particle_contacts(p, regions, way, margin, std::max(motion, demanded.gap + margin + spread));
        append_element_contacts(p, regions, way, demanded, margin);
      }
      for (Contact& contact : patch.contacts) contact.patch = p;
    }
  });
  for (const Index p : patches) {
    const std::vector<Contact>& found = patches_[at(p)].contacts;
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
}

// A particle of several patches is looked at in its first. A path no longer than the distance of its end from the surface cannot
// have crossed it.
void ObstacleSafeRegions::append_particle_contacts(Index p, PatchSafeRegions& regions, const Way& way, double margin,
                                                   double reach) {
  const Index k = regions.obstacle();
  Patch& patch = patches_[at(p)];
  const std::vector<Index>& particles = particles_of(p);
  regions.find_close({way.to, particles, set_.into_after(k)}, reach, patch.close);
  for (const Index slot : patch.close) {
    const Index i = particles[at(slot)];
    if (patch.own[at(slot)] == 0 || is_passing(k, i)) continue;
    const Vector3 from = way.from.col(i);
    const Vector3 to = way.to.col(i);
    if (!from.allFinite() || !to.allFinite()) continue;
    const auto contact = find_contact(set_, k, {i, from, to, surface_.thickness[i], margin}, regions.memory(slot));
    if (contact) patch.contacts.push_back(*contact);
  }
}

// Most elements that may touch are not about to.
void ObstacleSafeRegions::append_element_contacts(Index p, PatchSafeRegions& regions, const Way& way, const RegionDemand& demanded,
                                                  double margin) {
  const Index k = regions.obstacle();
  const RigidTransform& pose = set_.after(k);
  const ElementPatch& patch = surface_.patches[at(p)];
  const PatchPaths ways = paths(p, k, way);
  for (const Index e : regions.near_elements()) {
    if (regions.region(e).broken) continue;
    const SafeRegion& region = regions.look_again(set_.shape(k), patches_[at(p)].topology, ways, demanded, e);
    if (region.weights.maxCoeff() > kAtCorner) continue;
    const Element& element = surface_.elements[at(patch.first_element + e)];
    Vector3 sum = Vector3::Zero();
    double thickness = 0.0;
    for (std::size_t c = 0; c < at(element.corners); ++c) {
      const Index i = element.particles[c];
      thickness = std::max(thickness, surface_.thickness[i]);
      if (region.weights[static_cast<Index>(c)] != 0.0) sum += region.weights[static_cast<Index>(c)] * way.to.col(i);
    }
    const Vector3 point = pose * region.point;
    const Vector3 normal = pose.linear() * region.normal;
    const double distance = normal.dot(sum - point);
    const double clearance = set_.clearance(k, sum, sum);
    const double gap = std::max(thickness + set_.obstacle(k).material.thickness, clearance);
    const auto corners = corners_of(element);
    const auto passes = [&](Index i) { return is_passing(k, i); };
    if (!(distance < gap + margin) || std::any_of(corners.begin(), corners.end(), passes)) continue;
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
