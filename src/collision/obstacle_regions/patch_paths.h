// The straight paths of particles in a step, and the particles and elements of a patch by slots: positions in its list of
// particles.
#pragma once

#include "collision/core/sphere_set.h"
#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sprung {

/// The straight paths of all particles in a step or a substep [m], 3 x n, and the obstacles in it. Refers to all of them.
struct StepPaths {
  const ObstacleFrame& obstacles;
  const Points& from;   ///< start positions, where nothing crosses
  const Points& to;     ///< target positions at the end of the obstacles' interval
  bool at_end = false;  ///< obstacles are at the end of their interval during the whole path
};

/// The paths of a patch's particles in an obstacle's frame, by slot. Refers to the positions, particles and poses it is made from.
class PatchPaths {
 public:
  PatchPaths(const SphereVertices& from, const SphereVertices& to) : from_(from), to_(to) {}

  [[nodiscard]] Vector3 from(Index slot) const { return position(from_, slot); }
  [[nodiscard]] Vector3 to(Index slot) const { return position(to_, slot); }
  [[nodiscard]] const SphereVertices& to() const { return to_; }

 private:
  [[nodiscard]] static Vector3 position(const SphereVertices& vertices, Index slot) {
    return vertices.into * vertices.positions.col(vertices.particles[static_cast<std::size_t>(slot)]);
  }

  SphereVertices from_;
  SphereVertices to_;
};

class PatchTopology {
 public:
  /// The corners of one element.
  struct Corners {
    std::array<Index, 3> slots{};
    int count = 0;
  };

  PatchTopology(const CollisionSurface& surface, const ElementPatch& patch);

  [[nodiscard]] Index element_count() const { return static_cast<Index>(corners_.size()); }
  [[nodiscard]] Index slot_count() const { return static_cast<Index>(first_.size()) - 1; }
  [[nodiscard]] const Corners& corners(Index element) const { return corners_[static_cast<std::size_t>(element)]; }
  /// The number of the element's corner that is at this slot. Requires that there is one.
  [[nodiscard]] std::size_t corner(Index element, Index slot) const {
    const auto& slots = corners(element).slots;
    return static_cast<std::size_t>(std::find(slots.begin(), slots.end(), slot) - slots.begin());
  }
  /// The elements with a corner at this slot, by their numbers in the patch.
  [[nodiscard]] std::span<const Index> elements_of(Index slot) const {
    const auto begin = static_cast<std::size_t>(first_[static_cast<std::size_t>(slot)]);
    const auto end = static_cast<std::size_t>(first_[static_cast<std::size_t>(slot) + 1]);
    return {elements_.data() + begin, end - begin};
  }

 private:
  std::vector<Corners> corners_;  ///< by element
  std::vector<Index> first_;      ///< by slot: index of its first entry in elements_
  std::vector<Index> elements_;   ///< grouped by slot
};

}  // namespace sprung
