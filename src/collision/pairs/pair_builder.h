// From elements that may touch to the convex parts of them that planes are to keep apart.
#pragma once

#include "collision/element_bvh/element_pair_filter.h"
#include "collision/element_bvh/neighbour_list_state.h"
#include "collision/pairs/contact_stencil.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

class PairBuilder {
 public:
  /// Keeps references to both.
  PairBuilder(const CollisionSurface& surface, const SurfaceTopology& features) : surface_(surface), features_(features) {}

  /// Appends the pairs of a meeting's elements that may touch within the horizon: both as wholes or, where they share a particle,
  /// each corner and face and each two edges that do not.
  void append_pairs(const ElementIndexPair& meeting, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;

 private:
  void append_corners(Index element, Index face, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;
  void append_edges(Index first, Index second, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;
  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
};

}  // namespace sprung
