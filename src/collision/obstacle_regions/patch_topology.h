// A patch's elements by the places that their corners have among the patch's particles.
#pragma once

#include "collision/surface/collision_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sprung {

class PatchTopology {
 public:
  struct Corners {
    std::array<Index, 3> slots{};
    int count = 0;
    bool pinned = false;  ///< one of them is
  };

  PatchTopology(const CollisionSurface& surface, const ElementPatch& patch);

  [[nodiscard]] Index element_count() const { return static_cast<Index>(corners_.size()); }
  [[nodiscard]] Index slot_count() const { return static_cast<Index>(first_.size()) - 1; }
  [[nodiscard]] const Corners& corners(Index element) const { return corners_[static_cast<std::size_t>(element)]; }
  /// Which of the element's corners is at this slot, one of them.
  [[nodiscard]] std::size_t corner(Index element, Index slot) const {
    const auto& slots = corners(element).slots;
    return static_cast<std::size_t>(std::find(slots.begin(), slots.end(), slot) - slots.begin());
  }
  /// The elements that have this slot as a corner, by their places in the patch.
  [[nodiscard]] std::span<const Index> elements_of(Index slot) const {
    const auto begin = static_cast<std::size_t>(first_[static_cast<std::size_t>(slot)]);
    const auto end = static_cast<std::size_t>(first_[static_cast<std::size_t>(slot) + 1]);
    return {elements_.data() + begin, end - begin};
  }

 private:
  std::vector<Corners> corners_;
  std::vector<Index> first_;  ///< by slot, into elements_
  std::vector<Index> elements_;
};

}  // namespace sprung
