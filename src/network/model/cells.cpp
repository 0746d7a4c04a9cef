#include "network/model/cells.h"

#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <algorithm>

namespace sprung {
namespace {

Tetrahedron part_of(const Hexahedron& cell, std::size_t part) {
  const std::array<int, 4>& corners = kTetrahedraOfHexahedron[part];
  return {cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]};
}

template <std::size_t corners>
void append_shifted(std::vector<std::array<Index, corners>>& cells, const std::vector<std::array<Index, corners>>& more,
                    Index offset) {
  for (std::array<Index, corners> cell : more) {
    for (Index& corner : cell) corner += offset;
    cells.push_back(cell);
  }
}

}  // namespace

void Cells::append(const Cells& cells, Index offset) {
  append_shifted(hexahedra, cells.hexahedra, offset);
  append_shifted(tetrahedra, cells.tetrahedra, offset);
}

double volume_of(const Tetrahedron& cell, const Eigen::Ref<const Points>& positions) { return tetrahedron_volume(positions, cell); }

double volume_of(const Hexahedron& cell, const Eigen::Ref<const Points>& positions) {
  double sum = 0.0;
  for (std::size_t part = 0; part < kTetrahedraOfHexahedron.size(); ++part) sum += volume_of(part_of(cell, part), positions);
  return 0.5 * sum;
}

bool is_inverted(const Tetrahedron& cell, const Eigen::Ref<const Points>& positions) { return !(volume_of(cell, positions) > 0.0); }

bool is_inverted(const Hexahedron& cell, const Eigen::Ref<const Points>& positions) {
  for (std::size_t corner = 0; corner < kCornersOfHexahedron; ++corner) {
    if (is_inverted(part_of(cell, corner), positions)) return true;
  }
  return false;
}

Index count_inverted(const Cells& cells, const Eigen::Ref<const Points>& positions) {
  const auto inverted = [&](const auto& cell) { return is_inverted(cell, positions); };
  return static_cast<Index>(std::ranges::count_if(cells.hexahedra, inverted) + std::ranges::count_if(cells.tetrahedra, inverted));
}

}  // namespace sprung
