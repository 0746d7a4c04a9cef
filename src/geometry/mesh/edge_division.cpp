#include "geometry/mesh/edge_division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace sprung {
namespace {

/// Vertices in a row.
using Row = std::vector<Index>;

bool comes_before(const Vector3& a, const Vector3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

class EdgeDivision {
 public:
  EdgeDivision(const TriangleMesh& mesh, double longest)
      : longest_(longest), positions_(mesh.vertices.colwise().begin(), mesh.vertices.colwise().end()) {
    for (const auto& corners : mesh.triangles.colwise()) divide({corners[0], corners[1], corners[2]});
  }

  [[nodiscard]] TriangleMesh mesh() const {
    TriangleMesh result{Points(3, static_cast<Index>(positions_.size())), Triangles(3, static_cast<Index>(triangles_.size()))};
    for (std::size_t v = 0; v < positions_.size(); ++v) result.vertices.col(static_cast<Index>(v)) = positions_[v];
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      result.triangles.col(static_cast<Index>(t)) << triangles_[t][0], triangles_[t][1], triangles_[t][2];
    }
    return result;
  }

 private:
  [[nodiscard]] double distance(Index a, Index b) const { return (positions_[a] - positions_[b]).norm(); }

  /// Rows of vertices from the corner opposite the shortest side to that side. Each of the other two sides is at most twice as long
  /// as the other one, so that no two rows begin and end at the same vertices.
  void divide(std::array<Index, 3> corners) {
    const auto opposite = [&](std::size_t k) { return distance(corners[(k + 1) % 3], corners[(k + 2) % 3]); };
    if (std::max({opposite(0), opposite(1), opposite(2)}) <= longest_) {
      triangles_.push_back(corners);
      return;
    }
    const std::array sides{opposite(0), opposite(1), opposite(2)};
    std::rotate(corners.begin(), corners.begin() + (std::ranges::min_element(sides) - sides.begin()), corners.end());
    const Row left = side(corners[0], corners[1]);
    const Row right = side(corners[0], corners[2]);
    const std::size_t rows = std::max(left.size(), right.size()) - 1;
    const auto at = [rows](const Row& ends, std::size_t row) { return ends[(2 * row * (ends.size() - 1) + rows) / (2 * rows)]; };
    Row above{corners[0]};
    for (std::size_t row = 1; row <= rows; ++row) {
      Row below = row < rows ? divided(at(left, row), at(right, row)) : side(corners[1], corners[2]);
      fill_between(above, below);
      above = std::move(below);
    }
  }

  /// The vertices of an edge of the mesh. Equal places have equal bits, whichever triangle comes first.
  Row side(Index from, Index to) {
    const bool forward = comes_before(positions_[from], positions_[to]);
    const auto [entry, is_new] = sides_.try_emplace(forward ? std::pair(from, to) : std::pair(to, from));
    if (is_new) entry->second = divided(entry->first.first, entry->first.second);
    return forward ? entry->second : Row(entry->second.rbegin(), entry->second.rend());
  }

  /// Adds vertices at equal distances between two.
  Row divided(Index from, Index to) {
    const Vector3 begin = positions_[from];
    const Vector3 whole = positions_[to] - begin;
    const double parts = std::ceil(whole.norm() / longest_);
    Row row{from};
    for (double k = 1.0; k < parts; ++k) {
      row.push_back(static_cast<Index>(positions_.size()));
      positions_.emplace_back(begin + k / parts * whole);
    }
    row.push_back(to);
    return row;
  }

  /// Triangles between two rows, with the shorter diagonals. The rows may share an end.
  void fill_between(const Row& above, const Row& below) {
    std::size_t a = 0;
    std::size_t b = 0;
    while (a + 1 < above.size() || b + 1 < below.size()) {
      const bool along_below =
          a + 1 == above.size() || (b + 1 < below.size() && distance(above[a], below[b + 1]) <= distance(above[a + 1], below[b]));
      const Index next = along_below ? below[b + 1] : above[a + 1];
      if (above[a] != below[b] && next != above[a] && next != below[b]) triangles_.push_back({above[a], below[b], next});
      ++(along_below ? b : a);
    }
  }

  double longest_;
  std::vector<Vector3> positions_;
  std::vector<std::array<Index, 3>> triangles_;
  std::map<std::pair<Index, Index>, Row> sides_;  ///< by their ends, from the first of them
};

}  // namespace

TriangleMesh divide_long_edges(TriangleMesh mesh, double longest) {
  const auto is_long = [&](const auto& corners) {
    const auto length = [&](int a, int b) { return (mesh.vertices.col(corners[a]) - mesh.vertices.col(corners[b])).norm(); };
    return std::max({length(0, 1), length(1, 2), length(2, 0)}) > longest;
  };
  if (std::ranges::none_of(mesh.triangles.colwise(), is_long)) return mesh;
  return EdgeDivision(mesh, longest).mesh();
}

}  // namespace sprung
