#include "geometry/import/flat_faces.h"
#include "geometry/import/mesh_import.h"
#include "geometry/import/mesh_orientation.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/topology.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

namespace sprung {
namespace {

Index vertex_count(const MeshSequence& mesh) { return static_cast<Index>(mesh.frames.front().cols()); }

// -1, 0 or 1, in the order of the coordinates in the first frame that separates the two vertices. Compared as numbers: -0 equals
// 0.
int compare(const std::vector<Points>& frames, Index a, Index b) {
  for (const Points& frame : frames) {
    for (int axis = 0; axis < 3; ++axis) {
      if (frame(axis, a) != frame(axis, b)) return frame(axis, a) < frame(axis, b) ? -1 : 1;
    }
  }
  return 0;
}

// For each vertex, the first vertex with its position in all frames.
std::vector<Index> first_alike(const std::vector<Points>& frames) {
  std::vector<Index> order(frames.front().cols());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const int sign = compare(frames, a, b);
    return sign != 0 ? sign < 0 : a < b;
  });
  std::vector<Index> first(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool alike = k > 0 && compare(frames, order[k - 1], order[k]) == 0;
    first[order[k]] = alike ? first[order[k - 1]] : order[k];
  }
  return first;
}

void weld(MeshSequence& mesh, MeshReport& report) {
  const std::vector<Index> first = first_alike(mesh.frames);
  for (Index& vertex : mesh.triangles.reshaped()) vertex = first[vertex];
  for (Index i = 0; i < std::ssize(first); ++i) report.welded_vertices += first[i] != i ? 1 : 0;
}

void keep_faces(MeshSequence& mesh, const std::vector<Index>& kept) {
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, kept));
}

void drop_duplicate_faces(MeshSequence& mesh, MeshReport& report) {
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

// A quad that exists twice, cut along one diagonal and along the other: no face is a duplicate, yet each side of the quad has a
// third face. (A tetrahedron is two such quads as well, but its sides have two faces.)
void drop_doubled_quads(MeshSequence& mesh, MeshReport& report) {
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

void drop_unused_vertices(MeshSequence& mesh, MeshReport& report) {
  std::vector<Index> number(vertex_count(mesh), kNone);
  for (const Index vertex : mesh.triangles.reshaped()) number[vertex] = 0;
  std::vector<Index> used;
  for (Index i = 0; i < std::ssize(number); ++i) {
    if (number[i] == kNone) continue;
    number[i] = static_cast<Index>(used.size());
    used.push_back(i);
  }
  for (Index& vertex : mesh.triangles.reshaped()) vertex = number[vertex];
  report.unused_vertices = static_cast<Index>(vertex_count(mesh) - report.welded_vertices - std::ssize(used));
  for (Points& frame : mesh.frames) frame = Points(frame(Eigen::all, used));
}

void note_components(Index components, const std::string& what, MeshReport& report) {
  if (components > 0) report.notes.push_back(std::to_string(components) + " component(s) " + what);
}

// The first frame decides: a deformation without tearing changes neither closedness nor orientation.
void orient_and_describe(MeshSequence& mesh, MeshReport& report) {
  TriangleMesh first{std::move(mesh.frames.front()), std::move(mesh.triangles)};
  const OrientationReport orientation = orient_faces(first);
  report.flipped_faces = orientation.flipped_faces;
  note_components(orientation.one_sided_components, "are one-sided, like a Moebius strip, and could not be oriented", report);
  note_components(orientation.flat_components,
                  "are closed but enclose no volume, like both sides of a sheet: the mesh is treated as open", report);
  describe_surface(first, report);
  report.closed = report.closed && orientation.flat_components == 0;
  mesh.frames.front() = std::move(first.vertices);
  mesh.triangles = std::move(first.triangles);
  for (const Points& frame : mesh.frames) report.bounds.extend(bounds(frame));
}

}  // namespace

ImportedSequence clean_sequence(MeshSequence raw) {
  ImportedSequence result{.sequence = std::move(raw), .report = {}};
  auto& [mesh, report] = result;
  report.vertices_read = vertex_count(mesh);
  report.faces_read = static_cast<Index>(mesh.triangles.cols());
  weld(mesh, report);
  report.degenerate_faces = remove_flat_faces(mesh);
  drop_duplicate_faces(mesh, report);
  drop_doubled_quads(mesh, report);
  drop_unused_vertices(mesh, report);
  orient_and_describe(mesh, report);
  return result;
}

ImportedMesh clean_mesh(const TriangleMesh& raw) {
  auto [sequence, report] = clean_sequence({.triangles = raw.triangles, .frames = {raw.vertices}});
  return {{std::move(sequence.frames.front()), std::move(sequence.triangles)}, std::move(report)};
}

}  // namespace sprung
