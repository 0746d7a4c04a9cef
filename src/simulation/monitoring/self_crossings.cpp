#include "simulation/monitoring/self_crossings.h"

#include "collision/surface/self_intersections.h"
#include "dynamics/contact/collision_surface_builder.h"

#include <algorithm>
#include <set>

namespace sprung {
namespace {

/// By body: the elements that cross a face of the body, and the faces crossed.
std::vector<std::set<Index>> crossing_elements(const CollisionSurface& surface, const Points& positions, std::size_t bodies) {
  std::vector<std::set<Index>> found(bodies);
  for (const auto& [first, second] : find_self_intersections(surface, positions)) {
    const Element& a = surface.elements[static_cast<std::size_t>(first)];
    const Element& b = surface.elements[static_cast<std::size_t>(second)];
    if (a.corners == 3 || b.corners == 3) found[static_cast<std::size_t>(a.body)].insert({first, second});
  }
  return found;
}

}  // namespace

std::vector<SelfCrossing> find_self_crossings(const SpringNetwork& network, const Points& positions) {
  CollisionSurface surface = contact_surface(network);
  // Search the bodies that contact does not search.
  for (char& self : surface.self) self = self == 0 ? 1 : 0;
  std::ranges::fill(surface.others, char{0});
  const std::vector<std::set<Index>> now = crossing_elements(surface, positions, network.bodies.size());
  if (std::ranges::all_of(now, [](const std::set<Index>& elements) { return elements.empty(); })) return {};
  const std::vector<std::set<Index>> at_start = crossing_elements(surface, network.positions, network.bodies.size());
  std::vector<SelfCrossing> crossings;
  for (std::size_t b = 0; b < now.size(); ++b) {
    if (!now[b].empty() && at_start[b].empty()) crossings.push_back({static_cast<Index>(b), static_cast<Index>(now[b].size())});
  }
  return crossings;
}

}  // namespace sprung
