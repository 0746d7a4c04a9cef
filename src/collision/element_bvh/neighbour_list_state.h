// Input of a search for pairs that may touch.
#pragma once

#include "collision/element_bvh/vertex_bounds.h"

#include <vector>

namespace sprung {

/// Particles at `positions` [m], 3 x n, and the spheres that bound them for `horizon` [steps] from now.
struct NeighbourListState {
  const Points& positions;
  const VertexBounds& spheres;
  double horizon = 0.0;
  const std::vector<char>& marked;  ///< by particle: only pairs with a marked particle (not 0) are searched
};

}  // namespace sprung
