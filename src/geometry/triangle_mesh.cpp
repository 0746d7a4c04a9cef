#include "geometry/triangle_mesh.h"

namespace sprung {

Box3 bounds(const Points& points) {
  Box3 box;
  for (Index i = 0; i < points.cols(); ++i) box.extend(Vector3(points.col(i)));
  return box;
}

Vector3 area_normal(const TriangleMesh& mesh, Index triangle) {
  const Vector3 a = mesh.vertices.col(mesh.triangles(0, triangle));
  const Vector3 b = mesh.vertices.col(mesh.triangles(1, triangle));
  const Vector3 c = mesh.vertices.col(mesh.triangles(2, triangle));
  return (b - a).cross(c - a);
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.cols() == 0) return 0.0;
  // Any apex gives the same sum; one on the mesh keeps the digits of a small mesh far from the origin.
  const Vector3 apex = mesh.vertices.col(mesh.triangles(0, 0));
  double six_volumes = 0.0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    six_volumes += area_normal(mesh, t).dot(mesh.vertices.col(mesh.triangles(0, t)) - apex);
  }
  return six_volumes / 6.0;
}

}  // namespace sprung
