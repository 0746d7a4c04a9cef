#include "collision/shapes/surface_anchor.h"

#include "collision/mesh_bvh/mesh_bvh.h"
#include "geometry/queries/closest_pair.h"

#include <array>
#include <limits>

namespace sprung {
namespace {

using Corners = std::array<Vector3, 3>;

Corners corners_at(const MeshSequence& sequence, Index triangle, double time) {
  const MeshSequence::Moment moment = sequence.at(time);
  const auto corner = sequence.triangles.col(triangle);
  return {sequence.position(corner[0], moment), sequence.position(corner[1], moment), sequence.position(corner[2], moment)};
}

/// Axes along the first edge, across it in the plane, and along the normal. A triangle without area has those of the world.
Matrix3 axes_of(const Corners& corners) {
  const Vector3 edge = corners[1] - corners[0];
  const Vector3 normal = edge.cross(corners[2] - corners[0]);
  if (normal.squaredNorm() == 0.0) return Matrix3::Identity();
  Matrix3 axes;
  axes.col(0) = edge.normalized();
  axes.col(2) = normal.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Vector3 point_of(const Corners& corners, const Vector3& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

}  // namespace

std::vector<Index> nearest_triangles(const MeshSequence& sequence, double time, const std::vector<Vector3>& points) {
  TriangleMesh mesh{{}, sequence.triangles};
  sequence.positions(sequence.at(time), mesh.vertices);
  const MeshBvh tree(mesh);
  std::vector<Index> triangles;
  triangles.reserve(points.size());
  for (const Vector3& point : points) {
    const auto nearest = tree.nearest(point, std::numeric_limits<double>::infinity());
    triangles.push_back(nearest ? nearest->triangle : 0);
  }
  return triangles;
}

SurfaceAnchor anchored(const MeshSequence& sequence, Index triangle, double time, const Vector3& point) {
  const Corners corners = corners_at(sequence, triangle, time);
  const ClosestPoint nearest = closest_point_on_triangle(point, corners[0], corners[1], corners[2]);
  const Vector3 weights = barycentric(nearest, corners[0], corners[1], corners[2]);
  return {triangle, weights, axes_of(corners).transpose() * (point - point_of(corners, weights))};
}

Vector3 anchored_position(const MeshSequence& sequence, const SurfaceAnchor& anchor, double time) {
  const Corners corners = corners_at(sequence, anchor.triangle, time);
  return point_of(corners, anchor.weights) + axes_of(corners) * anchor.offset;
}

}  // namespace sprung
