#include "collision/surface/collision_surface.h"

#include "base/grouped_entries.h"
#include "base/sort_unique.h"
#include "collision/core/block_bounds.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

// 4 x 4 squares of a cloth. The boxes of larger patches are too loose to reject much; smaller patches cause too many queries.
constexpr std::size_t kMostPatchElements = 32;

void add_single_particles(const std::vector<Index>& body_of, std::vector<Element>& elements) {
  std::vector<char> used(body_of.size(), 0);
  for (const Element& element : elements) {
    for (const Index particle : corners_of(element)) used[static_cast<std::size_t>(particle)] = 1;
  }
  for (std::size_t i = 0; i < body_of.size(); ++i) {
    if (used[i] == 0 && body_of[i] != kNone) elements.push_back({{static_cast<Index>(i), kNone, kNone}, 1, body_of[i]});
  }
  std::stable_sort(elements.begin(), elements.end(), [](const Element& a, const Element& b) { return a.body < b.body; });
}

std::vector<std::size_t> sort_into_patches(const Points& positions, std::vector<Element>& elements) {
  const Points middles = element_middles(elements, positions);
  std::vector<Index> order(elements.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = static_cast<Index>(e);

  std::vector<std::size_t> starts;
  for (std::size_t begin = 0; begin < elements.size();) {
    std::size_t end = begin;
    while (end < elements.size() && elements[end].body == elements[begin].body) ++end;
    bisect(middles, kMostPatchElements, order, begin, end, starts);
    begin = end;
  }
  std::vector<Element> sorted;
  sorted.reserve(elements.size());
  for (const Index e : order) sorted.push_back(elements[static_cast<std::size_t>(e)]);
  elements = std::move(sorted);
  return starts;
}

ElementPatch make_patch(const std::vector<Element>& elements, std::size_t begin, std::size_t end) {
  ElementPatch patch{.first_element = static_cast<Index>(begin), .element_count = static_cast<Index>(end - begin), .particles = {}};
  for (std::size_t e = begin; e < end; ++e) {
    const auto corners = corners_of(elements[e]);
    patch.particles.insert(patch.particles.end(), corners.begin(), corners.end());
  }
  sort_unique(patch.particles);
  return patch;
}

void list_slots(CollisionSurface& surface, std::size_t particles) {
  const auto visit_all = [&](const auto& add) {
    for (std::size_t p = 0; p < surface.patches.size(); ++p) {
      const std::vector<Index>& own = surface.patches[p].particles;
      for (std::size_t slot = 0; slot < own.size(); ++slot)
        add(own[slot], PatchSlot{static_cast<Index>(p), static_cast<Index>(slot)});
    }
  };
  group_entries(particles, visit_all, surface.first_slot, surface.slots);
}

std::vector<double> mean_edge_lengths(const std::vector<Element>& elements, const Points& positions, std::size_t bodies) {
  std::vector<double> length(bodies, 0.0);
  std::vector<double> edges(bodies, 0.0);
  for (const Element& element : elements) {
    const auto body = static_cast<std::size_t>(element.body);
    // A segment has one edge; the loop would count it twice.
    const int count = element.corners == 3 ? 3 : element.corners - 1;
    for (int k = 0; k < count; ++k) {
      const Index to = element.particles[static_cast<std::size_t>((k + 1) % element.corners)];
      length[body] += (positions.col(to) - positions.col(element.particles[static_cast<std::size_t>(k)])).norm();
      edges[body] += 1.0;
    }
  }
  for (std::size_t body = 0; body < bodies; ++body) length[body] /= std::max(edges[body], 1.0);
  return length;
}

}  // namespace

Points element_middles(const std::vector<Element>& elements, const Points& positions) {
  Points middles = Points::Zero(3, static_cast<Eigen::Index>(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    auto middle = middles.col(static_cast<Eigen::Index>(e));
    for (const Index particle : corners_of(elements[e])) middle += positions.col(particle);
    middle /= elements[e].corners;
  }
  return middles;
}

CollisionSurface make_collision_surface(std::vector<Element> elements, const Points& positions, const std::vector<Index>& body_of,
                                        Scalars thickness, ParticleMotions motions, std::vector<char> self,
                                        std::vector<char> others) {
  add_single_particles(body_of, elements);
  std::vector<std::size_t> starts = sort_into_patches(positions, elements);
  starts.push_back(elements.size());

  CollisionSurface surface{.elements = std::move(elements),
                           .patches = {},
                           .thickness = std::move(thickness),
                           .motions = std::move(motions),
                           .self = std::move(self),
                           .others = std::move(others),
                           .element_size = {},
                           .first_slot = {},
                           .slots = {}};
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    surface.patches.push_back(make_patch(surface.elements, starts[p], starts[p + 1]));
  }
  list_slots(surface, body_of.size());
  surface.element_size = mean_edge_lengths(surface.elements, positions, surface.self.size());
  return surface;
}

}  // namespace sprung
