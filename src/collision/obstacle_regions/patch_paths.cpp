#include "collision/obstacle_regions/patch_paths.h"

#include <algorithm>

namespace sprung {

PatchTopology::PatchTopology(const CollisionSurface& surface, const ElementPatch& patch) : first_(patch.particles.size() + 1, 0) {
  for (Index e = patch.first_element; e < patch.first_element + patch.element_count; ++e) {
    const Element& element = surface.elements[static_cast<std::size_t>(e)];
    Corners corners{.count = element.corners};
    for (std::size_t k = 0; k < static_cast<std::size_t>(element.corners); ++k) {
      const auto position = std::lower_bound(patch.particles.begin(), patch.particles.end(), element.particles[k]);
      corners.slots[k] = static_cast<Index>(position - patch.particles.begin());
      ++first_[static_cast<std::size_t>(corners.slots[k]) + 1];
    }
    corners_.push_back(corners);
  }
  for (std::size_t slot = 1; slot < first_.size(); ++slot) first_[slot] += first_[slot - 1];
  elements_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<Index> next = first_;
  for (std::size_t e = 0; e < corners_.size(); ++e) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(corners_[e].count); ++k) {
      const auto slot = static_cast<std::size_t>(corners_[e].slots[k]);
      elements_[static_cast<std::size_t>(next[slot]++)] = static_cast<Index>(e);
    }
  }
}

}  // namespace sprung
