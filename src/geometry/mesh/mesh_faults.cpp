#include "geometry/mesh/mesh_faults.h"

#include <algorithm>
#include <array>
#include <set>

namespace sprung {
namespace {

using Side = std::array<Index, 2>;

/// The sides that belong to one face alone.
std::vector<Side> border_sides(const PolygonFaces& faces) {
  std::vector<Side> sides;
  for (Index face = 0; face < faces.face_count(); ++face) {
    Index before = faces.vertex[faces.corner_begin[face + 1] - 1];
    for (Index corner = faces.corner_begin[face]; corner < faces.corner_begin[face + 1]; ++corner) {
      const Index vertex = faces.vertex[corner];
      sides.push_back({std::min(before, vertex), std::max(before, vertex)});
      before = vertex;
    }
  }
  std::ranges::sort(sides);
  std::vector<Side> border;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const bool again = (s > 0 && sides[s - 1] == sides[s]) || (s + 1 < sides.size() && sides[s + 1] == sides[s]);
    if (!again) border.push_back(sides[s]);
  }
  return border;
}

/// Whether the point is within `distance` of the edge, and farther from both ends.
bool is_on_edge(const Vector3& point, const Vector3& begin, const Vector3& end, double distance) {
  if ((point - begin).norm() <= distance || (point - end).norm() <= distance) return false;
  const Vector3 along = end - begin;
  const double fraction = along.dot(point - begin) / along.squaredNorm();
  return fraction > 0.0 && fraction < 1.0 && (begin + fraction * along - point).norm() <= distance;
}

std::vector<Index> sorted(std::vector<Index> corners) {
  std::ranges::sort(corners);
  return corners;
}

/// Whether a fan of triangles from one of the corners of a face with more than three is among the faces. Each division of a face
/// with four or five corners is a fan.
bool is_divided(const std::vector<Index>& corners, const std::set<std::vector<Index>>& faces) {
  const std::size_t count = corners.size();
  if (count < 4) return false;
  for (std::size_t first = 0; first < count; ++first) {
    bool all = true;
    for (std::size_t k = 1; all && k + 1 < count; ++k) {
      all = faces.contains(sorted({corners[first], corners[(first + k) % count], corners[(first + k + 1) % count]}));
    }
    if (all) return true;
  }
  return false;
}

}  // namespace

Index count_repeated_faces(const PolygonFaces& faces, const std::vector<Index>& group_of) {
  std::set<std::vector<Index>> seen;
  Index repeated = 0;
  const auto corners_of = [&](Index face) {
    std::vector<Index> corners;
    for (Index c = faces.corner_begin[face]; c < faces.corner_begin[face + 1]; ++c) corners.push_back(group_of[faces.vertex[c]]);
    return corners;
  };
  for (Index face = 0; face < faces.face_count(); ++face) {
    if (!seen.insert(sorted(corners_of(face))).second) ++repeated;
  }
  for (Index face = 0; face < faces.face_count(); ++face) {
    if (is_divided(corners_of(face), seen)) ++repeated;
  }
  return repeated;
}

// Sweep along one direction. No regular mesh is aligned with it, so few vertices lie within the interval of an edge.
std::vector<Index> vertices_on_border_edges(const Points& vertices, const PolygonFaces& faces, double distance) {
  const std::vector<Side> border = border_sides(faces);
  std::vector<Index> candidates;
  for (const auto& [first, second] : border) candidates.insert(candidates.end(), {first, second});
  std::ranges::sort(candidates);
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());

  const Vector3 direction = Vector3(1.0, 0.6180339887, 0.4142135624).normalized();
  const Scalars along = (direction.transpose() * vertices).transpose();
  const double rounding = 1e-12 * (vertices.cols() > 0 ? vertices.cwiseAbs().maxCoeff() : 0.0);
  const double reach = distance + rounding;
  std::ranges::sort(candidates, {}, [&](Index vertex) { return along[vertex]; });
  std::vector<Index> found;
  for (const auto& [first, second] : border) {
    const double low = std::min(along[first], along[second]) - reach;
    const double high = std::max(along[first], along[second]) + reach;
    auto at = std::ranges::lower_bound(candidates, low, {}, [&](Index vertex) { return along[vertex]; });
    for (; at != candidates.end() && along[*at] <= high; ++at) {
      if (*at == first || *at == second) continue;
      if (is_on_edge(vertices.col(*at), vertices.col(first), vertices.col(second), reach)) found.push_back(*at);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace sprung
