#include "geometry/mesh/vertex_normals.h"

#include "geometry/mesh/triangle_mesh.h"

#include <cmath>

namespace sprung {

Points vertex_normals(const Points& vertices, const Triangles& triangles) {
  Points normals = Points::Zero(3, vertices.cols());
  for (const auto& corners : triangles.colwise()) {
    const Vector3 p[] = {vertices.col(corners[0]), vertices.col(corners[1]), vertices.col(corners[2])};
    const Vector3 normal = area_normal(p[0], p[1], p[2]).stableNormalized();
    for (int k = 0; k < 3; ++k) {
      const Vector3 u = p[(k + 1) % 3] - p[k];
      const Vector3 v = p[(k + 2) % 3] - p[k];
      normals.col(corners[k]) += std::atan2(u.cross(v).norm(), u.dot(v)) * normal;
    }
  }
  for (auto normal : normals.colwise()) {
    const double length = normal.norm();
    if (length > 0.0) {
      normal /= length;
    } else {
      normal = Vector3::UnitY();
    }
  }
  return normals;
}

}  // namespace sprung
