#include "geometry/mesh/pseudonormal.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace sprung {

namespace {

double corner_angle(const TriangleMesh& mesh, Index triangle, int corner) {
  const auto vertices = mesh.triangles.col(triangle);
  const Vector3 tip = mesh.vertices.col(vertices[corner]);
  const Vector3 u = mesh.vertices.col(vertices[(corner + 1) % 3]) - tip;
  const Vector3 v = mesh.vertices.col(vertices[(corner + 2) % 3]) - tip;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// Sums the face normals at each edge. Sorting brings the sides of an edge together.
void add_edge_normals(const Triangles& triangles, const Points& face, Points& edge) {
  struct Side {
    Index low;
    Index high;
    Index slot;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(3 * triangles.cols()));
  for (Index t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({triangles(k, t), triangles((k + 1) % 3, t)});
      sides.push_back({low, high, 3 * t + k});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(
        begin, sides.end(), [&](const Side& side) { return std::tie(side.low, side.high) != std::tie(begin->low, begin->high); });
    Vector3 sum = Vector3::Zero();
    for (auto side = begin; side != end; ++side) sum += face.col(side->slot / 3);
    for (auto side = begin; side != end; ++side) edge.col(side->slot) = sum;
    begin = end;
  }
}

Vector3 face_normal(const TriangleMesh& mesh, Index triangle) { return area_normal(mesh, triangle).normalized(); }

/// The corner of the triangle at the vertex; 3 if it is not a corner.
int corner_at(const TriangleMesh& mesh, Index triangle, Index vertex) {
  int corner = 0;
  while (corner < 3 && mesh.triangles(corner, triangle) != vertex) ++corner;
  return corner;
}

}  // namespace

Vector3 Pseudonormals::at(const Triangles& triangles, Index triangle, TriangleFeature feature) const {
  const int number = static_cast<int>(feature);
  if (number < 3) return vertex.col(triangles(number, triangle));
  if (number < 6) return edge.col(3 * triangle + number - 3);
  return face.col(triangle);
}

Pseudonormals pseudonormals(const TriangleMesh& mesh) {
  const auto count = mesh.triangles.cols();
  Pseudonormals normals{Points(3, count), Points(3, 3 * count), Points::Zero(3, mesh.vertices.cols())};
  for (Index t = 0; t < count; ++t) {
    normals.face.col(t) = face_normal(mesh, t);
    for (int k = 0; k < 3; ++k) normals.vertex.col(mesh.triangles(k, t)) += corner_angle(mesh, t, k) * normals.face.col(t);
  }
  add_edge_normals(mesh.triangles, normals.face, normals.edge);
  return normals;
}

Vector3 pseudonormal(const TriangleMesh& mesh, const VertexTriangles& around, Index triangle, TriangleFeature feature) {
  const int number = static_cast<int>(feature);
  if (feature == TriangleFeature::face) return face_normal(mesh, triangle);
  const Index vertex = mesh.triangles(number % 3, triangle);
  const Index other = number < 3 ? kNone : mesh.triangles((number + 1) % 3, triangle);
  Vector3 sum = Vector3::Zero();
  for (Index i = around.first[vertex]; i < around.first[vertex + 1]; ++i) {
    const Index t = around.triangle[i];
    if (other == kNone) sum += corner_angle(mesh, t, corner_at(mesh, t, vertex)) * face_normal(mesh, t);
    if (other != kNone && corner_at(mesh, t, other) < 3) sum += face_normal(mesh, t);
  }
  return sum;
}

}  // namespace sprung
