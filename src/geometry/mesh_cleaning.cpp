#include "geometry/mesh_import.h"
#include "geometry/mesh_orientation.h"
#include "geometry/topology.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

namespace sprung {
namespace {

// A triangle this flat, height over longest side, is a line: its normal would be rounding noise.
constexpr double kFlat = 1e-12;

// For each vertex, the first one at its position; coordinates are compared as numbers, so -0 equals 0.
std::vector<Index> first_alike(const Points& vertices) {
  const auto key = [&](Index i) { return std::array{vertices(0, i), vertices(1, i), vertices(2, i)}; };
  std::vector<Index> order(vertices.cols());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<Index> first(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool alike = k > 0 && key(order[k - 1]) == key(order[k]);
    first[order[k]] = alike ? first[order[k - 1]] : order[k];
  }
  return first;
}

void weld(TriangleMesh& mesh, MeshReport& report) {
  const std::vector<Index> first = first_alike(mesh.vertices);
  for (Index& vertex : mesh.triangles.reshaped()) vertex = first[vertex];
  for (Index i = 0; i < std::ssize(first); ++i) report.welded_vertices += first[i] != i ? 1 : 0;
}

bool is_degenerate(const TriangleMesh& mesh, Index triangle) {
  const auto corner = [&](Index k) { return Vector3(mesh.vertices.col(mesh.triangles(k % 3, triangle))); };
  double longest = 0.0;  // squared
  for (Index k = 0; k < 3; ++k) longest = std::max(longest, (corner(k + 1) - corner(k)).squaredNorm());
  return area_normal(mesh, triangle).norm() <= kFlat * longest;
}

void keep_faces(TriangleMesh& mesh, const std::vector<Index>& kept) {
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, kept));
}

void drop_degenerate_faces(TriangleMesh& mesh, MeshReport& report) {
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    if (!is_degenerate(mesh, t)) kept.push_back(t);
  }
  report.degenerate_faces = static_cast<Index>(mesh.triangles.cols() - std::ssize(kept));
  keep_faces(mesh, kept);
}

void drop_duplicate_faces(TriangleMesh& mesh, MeshReport& report) {
  using Face = std::pair<std::array<Index, 3>, Index>;
  std::vector<Face> faces;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    std::array<Index, 3> corners{mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)};
    std::sort(corners.begin(), corners.end());
    faces.emplace_back(corners, t);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.first == b.first; }),
              faces.end());
  report.duplicate_faces = static_cast<Index>(mesh.triangles.cols() - std::ssize(faces));
  std::vector<Index> kept;
  for (const Face& face : faces) kept.push_back(face.second);
  std::sort(kept.begin(), kept.end());
  keep_faces(mesh, kept);
}

// A quad that is there twice, cut along one diagonal and along the other: no face is a duplicate, yet each side of the quad has a
// third face. (A tetrahedron is two such quads as well, but its sides have two faces.)
void drop_doubled_quads(TriangleMesh& mesh, MeshReport& report) {
  const std::vector<MeshEdge> edges = mesh_edges(mesh.triangles);
  const auto uses = [&](Index a, Index b) {
    const std::array<Index, 2> vertices{std::min(a, b), std::max(a, b)};
    return std::lower_bound(edges.begin(), edges.end(), vertices, [](const MeshEdge& e, const auto& v) { return e.vertices < v; })
        ->uses;
  };
  const auto has_crowded_sides = [&](const MeshEdge& diagonal) {
    for (const Index a : diagonal.vertices) {
      for (const Index b : diagonal.opposite) {
        if (uses(a, b) < 3) return false;
      }
    }
    return true;
  };
  std::set<std::array<Index, 4>> quads;
  std::vector<bool> dropped(mesh.triangles.cols(), false);
  for (const MeshEdge& diagonal : edges) {
    if (diagonal.uses != 2 || !has_crowded_sides(diagonal)) continue;
    std::array<Index, 4> corners{diagonal.vertices[0], diagonal.vertices[1], diagonal.opposite[0], diagonal.opposite[1]};
    std::sort(corners.begin(), corners.end());
    if (quads.insert(corners).second) continue;
    for (const Index triangle : diagonal.triangles) dropped[triangle] = true;
  }
  if (quads.empty()) return;
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    if (!dropped[t]) kept.push_back(t);
  }
  report.duplicate_faces += static_cast<Index>(mesh.triangles.cols() - std::ssize(kept));
  keep_faces(mesh, kept);
}

void drop_unused_vertices(TriangleMesh& mesh, MeshReport& report) {
  std::vector<Index> number(mesh.vertices.cols(), kNone);
  for (const Index vertex : mesh.triangles.reshaped()) number[vertex] = 0;
  std::vector<Index> used;
  for (Index i = 0; i < std::ssize(number); ++i) {
    if (number[i] == kNone) continue;
    number[i] = static_cast<Index>(used.size());
    used.push_back(i);
  }
  for (Index& vertex : mesh.triangles.reshaped()) vertex = number[vertex];
  report.unused_vertices = static_cast<Index>(mesh.vertices.cols() - report.welded_vertices - std::ssize(used));
  mesh.vertices = Points(mesh.vertices(Eigen::all, used));
}

void orient(TriangleMesh& mesh, MeshReport& report) {
  const OrientationReport orientation = orient_faces(mesh);
  report.flipped_faces = orientation.flipped_faces;
  if (orientation.one_sided_parts == 0) return;
  report.notes.push_back(std::to_string(orientation.one_sided_parts) +
                         " part(s) have one side only, like a Moebius strip, and could not be oriented");
}

}  // namespace

ImportedMesh clean_mesh(const TriangleMesh& raw) {
  ImportedMesh result{.mesh = raw, .report = {}};
  result.report.vertices_read = static_cast<Index>(raw.vertices.cols());
  result.report.faces_read = static_cast<Index>(raw.triangles.cols());
  weld(result.mesh, result.report);
  drop_degenerate_faces(result.mesh, result.report);
  drop_duplicate_faces(result.mesh, result.report);
  drop_doubled_quads(result.mesh, result.report);
  drop_unused_vertices(result.mesh, result.report);
  orient(result.mesh, result.report);
  describe_surface(result.mesh, result.report);
  return result;
}

}  // namespace sprung
