// From pairs of elements that may touch to the stencils that planes keep apart.
#pragma once

#include "collision/element_bvh/element_pair_filter.h"
#include "collision/element_bvh/vertex_bounds.h"
#include "collision/pairs/contact_stencil.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

/// Particles at `positions` [m], 3 x n, and the spheres that bound them for `horizon` [steps] from now.
struct NeighbourListState {
  const Points& positions;
  const VertexBounds& spheres;
  double horizon = 0.0;
  const std::vector<char>& marked;  ///< by particle: only pairs with a marked particle (not 0) are searched
};

/// Builds the stencils of a neighbour list.
class PairBuilder {
 public:
  /// Keeps references to both arguments.
  PairBuilder(const CollisionSurface& surface, const SurfaceTopology& topology) : surface_(surface), topology_(topology) {}

  /// Appends the stencils of two elements that may touch within the horizon: the two as a whole or, if they share a particle, each
  /// vertex-face and edge-edge pair of them that shares none.
  void append_pairs(const ElementIndexPair& elements, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;

 private:
  void append_vertices(Index element, Index face, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;
  void append_edges(Index first, Index second, const NeighbourListState& state, std::vector<ContactStencil>& pairs) const;
  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }

  const CollisionSurface& surface_;
  const SurfaceTopology& topology_;
};

}  // namespace sprung
