// The cells that fill a solid, and their signed volumes.
#pragma once

#include "base/types.h"

#include <array>
#include <vector>

namespace sprung {

/// Corners of a cell of a lattice: x runs fastest, then y, then z. Corner c has x, y, z = bits 0, 1, 2 of c.
using Hexahedron = std::array<Index, 8>;

/// Corners of a tetrahedron: the others turn clockwise seen from the first, so that its volume is positive.
using Tetrahedron = std::array<Index, 4>;

/// A point within a cell as a weighted sum of its corners; the weights are at least 0 and add up to 1.
struct CellPoint {
  Hexahedron corners;
  std::array<double, 8> weights;
};

struct Cells {
  std::vector<Hexahedron> hexahedra;
  std::vector<Tetrahedron> tetrahedra;

  [[nodiscard]] bool empty() const { return hexahedra.empty() && tetrahedra.empty(); }
  void append(const Cells& cells, Index offset);
};

/// Tetrahedra within a hexahedron, as corners. The first 8 span a corner and its three neighbours and have a sixth of the volume
/// of a box each; the last 2 are in the middle and have a third. Half of the sum of all is the volume of a hexahedron whose faces
/// are bilinear.
inline constexpr std::array<std::array<int, 4>, 10> kTetrahedraOfHexahedron{{{0, 1, 2, 4},
                                                                             {1, 3, 0, 5},
                                                                             {2, 0, 3, 6},
                                                                             {3, 2, 1, 7},
                                                                             {4, 6, 5, 0},
                                                                             {5, 4, 7, 1},
                                                                             {6, 7, 4, 2},
                                                                             {7, 5, 6, 3},
                                                                             {1, 2, 4, 7},
                                                                             {0, 5, 3, 6}}};
inline constexpr std::size_t kCornersOfHexahedron = 8;

/// Signed volume [m^3]; positions [m], 3 x n.
[[nodiscard]] double volume_of(const Tetrahedron& cell, const Eigen::Ref<const Points>& positions);
[[nodiscard]] double volume_of(const Hexahedron& cell, const Eigen::Ref<const Points>& positions);

/// Whether a cell is inside out: the tetrahedron, or one at a corner of the hexahedron, has no positive volume.
[[nodiscard]] bool is_inverted(const Tetrahedron& cell, const Eigen::Ref<const Points>& positions);
[[nodiscard]] bool is_inverted(const Hexahedron& cell, const Eigen::Ref<const Points>& positions);

/// Number of cells that are inside out.
[[nodiscard]] Index count_inverted(const Cells& cells, const Eigen::Ref<const Points>& positions);

}  // namespace sprung
