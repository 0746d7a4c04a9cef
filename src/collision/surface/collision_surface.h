// The collision mesh of the network: triangles of surfaces, segments of ropes, and single particles that belong to neither.
#pragma once

#include "base/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sprung {

/// A triangle, a segment or a single particle: the convex hull of its corners.
struct Element {
  std::array<Index, 3> particles{kNone, kNone, kNone};  ///< the first `corners` are used
  int corners = 0;                                      ///< 3: a triangle, 2: a segment, 1: a particle
  Index body = kNone;
};

[[nodiscard]] inline std::span<const Index> corners_of(const Element& element) {
  return {element.particles.data(), static_cast<std::size_t>(element.corners)};
}

/// The mean of each element's corners [m], one column per element.
[[nodiscard]] Points element_middles(const std::vector<Element>& elements, const Points& positions);

/// How a particle moves in a step.
enum class ParticleMotion : std::uint8_t {
  free,     ///< forces and contact; truncation stops it
  driven,   ///< moved by a pin, never stopped; its elements may cross obstacles and other elements
  at_rest,  ///< asleep, or a pin keeps it still; only obstacles and driven particles may cross its elements
};
using ParticleMotions = std::vector<ParticleMotion>;  ///< by particle

/// Whether neither contact nor truncation may move the particle: it is driven or at rest.
[[nodiscard]] inline bool is_fixed(const ParticleMotions& motions, Index particle) {
  return motions[static_cast<std::size_t>(particle)] != ParticleMotion::free;
}

/// Elements that are neighbours in the initial positions. The broad phase is queried once per patch.
struct ElementPatch {
  Index first_element = 0;
  Index element_count = 0;
  std::vector<Index> particles;  ///< of its elements, ascending, each once
};

/// A patch that contains a particle, and where.
struct PatchSlot {
  Index patch = kNone;
  Index slot = kNone;  ///< index in `particles` of the patch
};

/// A particle that collides belongs to at least one element. Elements of a patch are consecutive and belong to one body.
struct CollisionSurface {
  std::vector<Element> elements;
  std::vector<ElementPatch> patches;
  Scalars thickness;                 ///< each particle's contribution to the gap [m]
  ParticleMotions motions;           ///< of each particle; the only member that changes when pins or sleepers do
  std::vector<char> self;            ///< by body: whether its elements collide with each other
  std::vector<char> others;          ///< by body: whether they collide with those of other bodies that do so too
  std::vector<double> element_size;  ///< by body: the mean length [m] of its elements' edges; 0 for single particles

  /// The patches that contain particle i: slots [first_slot[i], first_slot[i + 1]).
  std::vector<Index> first_slot;
  std::vector<PatchSlot> slots;
};

/// Divides the elements, which are sorted by body, into patches of neighbours by bisection of their middles at `positions` [m], 3
/// x n. A particle without an element gets an element of its own. `body_of` is the body of each particle; kNone: it does not
/// collide. Element sizes are measured at `positions`. The other arguments become the members of the same name.
[[nodiscard]] CollisionSurface make_collision_surface(std::vector<Element> elements, const Points& positions,
                                                      const std::vector<Index>& body_of, Scalars thickness, ParticleMotions motions,
                                                      std::vector<char> self, std::vector<char> others);

}  // namespace sprung
