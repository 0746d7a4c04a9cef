// What of the network collides: triangles of surfaces, segments of ropes, and single particles that belong to neither.
#pragma once

#include "base/types.h"

#include <array>
#include <span>
#include <vector>

namespace sprung {

/// A triangle, a segment or a single particle. Within it the network is the convex hull of its corners.
struct Element {
  std::array<Index, 3> particles{kNone, kNone, kNone};  ///< the first `corners` of them are used
  int corners = 0;                                      ///< 3: a triangle, 2: a segment, 1: a particle
  Index body = kNone;
};

[[nodiscard]] inline std::span<const Index> corners_of(const Element& element) {
  return {element.particles.data(), static_cast<std::size_t>(element.corners)};
}

/// The mean of each element's corners [m], a column per element.
[[nodiscard]] Points element_middles(const std::vector<Element>& elements, const Points& positions);

/// Elements that are neighbours in space as the network was built: what the broad phase is asked for.
struct ElementPatch {
  Index first_element = 0;
  Index element_count = 0;
  std::vector<Index> particles;  ///< of its elements, ascending, each once
};

/// Where a particle is found among the patches.
struct PatchSlot {
  Index patch = kNone;
  Index slot = kNone;  ///< its place in `particles` of the patch
};

/// Every particle of the network belongs to at least one element. Elements of a patch follow each other and belong to one body.
struct CollisionSurface {
  std::vector<Element> elements;
  std::vector<ElementPatch> patches;
  Scalars thickness;                 ///< each particle's share of the gap [m]
  std::vector<char> pinned;          ///< 1 for particles that follow their pin, whatever is in the way
  std::vector<char> self;            ///< by body: whether its elements collide with each other
  std::vector<char> others;          ///< by body: whether they collide with those of other bodies that do so too
  std::vector<double> element_size;  ///< by body: the mean length [m] of its elements' edges; 0 for single particles

  /// The patches that hold a particle: slots [first_slot[i], first_slot[i + 1]).
  std::vector<Index> first_slot;
  std::vector<PatchSlot> slots;
};

/// Cuts the elements, which are sorted by body, into patches of neighbours by bisecting their middles at `positions` [m], 3 x n;
/// particles without an element get one of their own. `body_of` names each particle's body. Sizes are measured at `positions`.
/// The other arguments become the members of the same name.
[[nodiscard]] CollisionSurface make_collision_surface(std::vector<Element> elements, const Points& positions,
                                                      const std::vector<Index>& body_of, Scalars thickness,
                                                      std::vector<char> pinned, std::vector<char> self, std::vector<char> others);

}  // namespace sprung
