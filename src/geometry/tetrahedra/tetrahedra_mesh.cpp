#include "geometry/tetrahedra/tetrahedra_mesh.h"

#include <algorithm>
#include <tuple>

namespace sprung {
namespace {

// The sides of a tetrahedron of positive volume, counter-clockwise seen from outside.
constexpr int kSides[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

}  // namespace

double tetrahedron_volume(const Eigen::Ref<const Points>& vertices, const std::array<Index, 4>& corners) {
  const Vector3 origin = vertices.col(corners[0]);
  const Vector3 b = vertices.col(corners[1]) - origin;
  const Vector3 c = vertices.col(corners[2]) - origin;
  const Vector3 d = vertices.col(corners[3]) - origin;
  return b.cross(c).dot(d) / 6.0;
}

std::vector<TetrahedronSide> tetrahedron_sides(const std::vector<std::array<Index, 4>>& tetrahedra) {
  std::vector<TetrahedronSide> sides;
  sides.reserve(4 * tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    for (const auto& [a, b, c] : kSides) {
      const std::array<Index, 3> corners{tetrahedra[t][a], tetrahedra[t][b], tetrahedra[t][c]};
      TetrahedronSide& side = sides.emplace_back(TetrahedronSide{corners, corners, static_cast<Index>(t)});
      std::sort(side.sorted.begin(), side.sorted.end());
    }
  }
  std::sort(sides.begin(), sides.end(), [](const TetrahedronSide& a, const TetrahedronSide& b) {
    return std::tie(a.sorted, a.tetrahedron) < std::tie(b.sorted, b.tetrahedron);
  });
  return sides;
}

Triangles boundary_triangles(const std::vector<std::array<Index, 4>>& tetrahedra) {
  const std::vector<TetrahedronSide> sides = tetrahedron_sides(tetrahedra);
  std::vector<TetrahedronSide> outer;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const bool as_previous = s > 0 && sides[s - 1].sorted == sides[s].sorted;
    const bool as_next = s + 1 < sides.size() && sides[s + 1].sorted == sides[s].sorted;
    if (!as_previous && !as_next) outer.push_back(sides[s]);
  }
  std::stable_sort(outer.begin(), outer.end(),
                   [](const TetrahedronSide& a, const TetrahedronSide& b) { return a.tetrahedron < b.tetrahedron; });
  Triangles triangles(3, static_cast<Eigen::Index>(outer.size()));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const std::array<Index, 3>& corners = outer[static_cast<std::size_t>(t)].corners;
    triangles.col(t) << corners[0], corners[1], corners[2];
  }
  return triangles;
}

}  // namespace sprung
