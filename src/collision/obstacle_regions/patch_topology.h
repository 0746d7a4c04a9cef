// The elements of a patch, their corners given by slots: positions in the patch's list of particles.
#pragma once

#include "collision/surface/collision_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sprung {

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
