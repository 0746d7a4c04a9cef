#include "geometry/mesh/weld.h"

#include "base/error.h"
#include "base/format.h"
#include "geometry/mesh/union_find.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace sprung {
namespace {

constexpr double kRounding = 1e-12;
constexpr int kDigits = 3;
const char* const kRemedy = "give a smaller distance, or repair the mesh";

struct ShortestEdge {
  double length = std::numeric_limits<double>::infinity();
  Index first = 0;
  Index second = 0;
};

/// Calls `use(a, b)` for the ends of each edge of a face and of each line.
template <class Use>
void for_each_edge(const PolygonMesh& mesh, const Use& use) {
  const PolygonFaces& faces = mesh.faces;
  for (Index face = 0; face < faces.face_count(); ++face) {
    Index before = faces.vertex[faces.corner_begin[face + 1] - 1];
    for (Index corner = faces.corner_begin[face]; corner < faces.corner_begin[face + 1]; ++corner) {
      use(std::exchange(before, faces.vertex[corner]), faces.vertex[corner]);
    }
  }
  for (const auto& line : mesh.lines.colwise()) use(line[0], line[1]);
}

ShortestEdge shortest_edge(const PolygonMesh& mesh) {
  ShortestEdge shortest;
  for_each_edge(mesh, [&](Index a, Index b) {
    const double length = (mesh.vertices.col(a) - mesh.vertices.col(b)).norm();
    if (length < shortest.length) shortest = {length, a, b};
  });
  return shortest;
}

[[noreturn]] void refuse(double distance, std::string rule, std::string remedy) {
  throw InputError(Problem{.key = "weld", .value = format_number(distance), .rule = std::move(rule), .remedy = std::move(remedy)});
}

void check_elements(const PolygonMesh& mesh, double distance) {
  const PolygonFaces& faces = mesh.faces;
  for (Index face = 0; face < faces.face_count(); ++face) {
    std::vector<Index> corners(faces.vertex.begin() + faces.corner_begin[face],
                               faces.vertex.begin() + faces.corner_begin[face + 1]);
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) == corners.end()) continue;
    refuse(distance, "welds two corners of face " + std::to_string(face), kRemedy);
  }
  for (Index line = 0; line < mesh.lines.cols(); ++line) {
    if (mesh.lines(0, line) == mesh.lines(1, line)) refuse(distance, "welds both ends of line " + std::to_string(line), kRemedy);
  }
}

}  // namespace

// Sorted along a direction that no regular mesh is aligned with, few vertices are near each other without being neighbours.
std::vector<Index> coincident_groups(const Points& vertices, double distance) {
  const Vector3 direction = Vector3(1.0, 0.6180339887, 0.4142135624).normalized();
  const Scalars along = (direction.transpose() * vertices).transpose();
  const auto count = static_cast<std::size_t>(vertices.cols());
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::pair(along[a], a) < std::pair(along[b], b); });
  const double reach = distance + kRounding * (count > 0 ? vertices.cwiseAbs().maxCoeff() : 0.0);
  UnionFind groups(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count && along[order[j]] - along[order[i]] <= reach; ++j) {
      if ((vertices.col(order[i]) - vertices.col(order[j])).norm() <= distance) groups.join(order[i], order[j]);
    }
  }
  std::vector<Index> lowest(count, kNone);
  std::vector<Index> group(count);
  for (Index i = 0; i < static_cast<Index>(count); ++i) {
    Index& first = lowest[groups.root(i)];
    if (first == kNone) first = i;
    group[i] = first;
  }
  return group;
}

WeldedMesh weld(PolygonMesh mesh, double distance) {
  const ShortestEdge shortest = shortest_edge(mesh);
  if (!(distance < shortest.length)) {
    refuse(distance,
           "must be smaller than every edge; that from vertex " + std::to_string(shortest.first) + " to " +
               std::to_string(shortest.second) + " is " + format_number(shortest.length, kDigits) + " m long",
           shortest.length > 0.0 ? "give a smaller distance" : "repair the mesh");
  }
  const std::vector<Index> groups = coincident_groups(mesh.vertices, distance);
  WeldedMesh welded{.mesh = {}, .vertex_of = std::vector<Index>(groups.size())};
  Index kept = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const bool first = groups[i] == static_cast<Index>(i);
    welded.vertex_of[i] = first ? kept : welded.vertex_of[groups[i]];
    if (first) mesh.vertices.col(kept++) = mesh.vertices.col(static_cast<Index>(i));
  }
  mesh.vertices.conservativeResize(3, kept);
  for (Index& vertex : mesh.faces.vertex) vertex = welded.vertex_of[vertex];
  for (Index& end : mesh.lines.reshaped()) end = welded.vertex_of[end];
  check_elements(mesh, distance);
  welded.mesh = std::move(mesh);
  return welded;
}

}  // namespace sprung
