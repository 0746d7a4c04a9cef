// What a search for pairs that may touch goes by.
#pragma once

#include "collision/element_bvh/vertex_bounds.h"

#include <vector>

namespace sprung {

/// Particles at `positions` [m], in balls that bound them for `horizon` [steps] from now.
struct NeighbourListState {
  const Points& positions;
  const VertexBounds& balls;
  double horizon = 0.0;
  const std::vector<char>& marked;  ///< by particle, not 0: only pairs that have one of these are looked for
};

}  // namespace sprung
