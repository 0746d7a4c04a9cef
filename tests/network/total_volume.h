// The volume of solids.
#pragma once

#include "network/model/cells.h"

namespace sprung::testing {

/// Volume [m^3] of all cells; positions [m], 3 x n.
inline double total_volume(const Cells& cells, const Eigen::Ref<const Points>& positions) {
  double sum = 0.0;
  for (const Hexahedron& cell : cells.hexahedra) sum += volume_of(cell, positions);
  for (const Tetrahedron& cell : cells.tetrahedra) sum += volume_of(cell, positions);
  return sum;
}

}  // namespace sprung::testing
