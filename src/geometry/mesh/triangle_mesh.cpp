#include "geometry/mesh/triangle_mesh.h"

namespace sprung {

Box3 bounds(const Points& points) {
  Box3 box;
  for (Index i = 0; i < points.cols(); ++i) box.extend(Vector3(points.col(i)));
  return box;
}

Vector3 area_normal(const Vector3& a, const Vector3& b, const Vector3& c) { return (b - a).cross(c - a); }

Vector3 area_normal(const TriangleMesh& mesh, Index triangle) {
  const auto corner = [&](Index k) { return Vector3(mesh.vertices.col(mesh.triangles(k, triangle))); };
  return area_normal(corner(0), corner(1), corner(2));
}

double signed_volume(const TriangleMesh& mesh) { return signed_volume(mesh.vertices, mesh.triangles); }

double signed_volume(const Eigen::Ref<const Points>& vertices, const Triangles& triangles) {
  if (triangles.cols() == 0) return 0.0;
  // Any apex gives the same sum; one on the mesh keeps the digits of a small mesh far from the origin.
  const Vector3 apex = vertices.col(triangles(0, 0));
  double six_volumes = 0.0;
  for (const auto& corners : triangles.colwise()) {
    const Vector3 a = vertices.col(corners[0]);
    six_volumes += area_normal(a, vertices.col(corners[1]), vertices.col(corners[2])).dot(a - apex);
  }
  return six_volumes / 6.0;
}

// Each triangle gives a third of its area along its normal to each corner; the sums are the derivatives if the mesh is closed.
void add_volume_gradients(const Eigen::Ref<const Points>& vertices, const Triangles& triangles, double factor,
                          Eigen::Ref<Points> sums) {
  for (const auto& corners : triangles.colwise()) {
    const Vector3 share = factor / 6.0 * area_normal(vertices.col(corners[0]), vertices.col(corners[1]), vertices.col(corners[2]));
    for (const Index corner : corners) sums.col(corner) += share;
  }
}

}  // namespace sprung
