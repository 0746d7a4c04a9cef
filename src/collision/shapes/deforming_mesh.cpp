#include "collision/shapes/deforming_mesh.h"

#include "geometry/queries/closest_pair.h"

#include <cmath>
#include <utility>

namespace sprung {

DeformingMesh::DeformingMesh(std::shared_ptr<const MeshSequence> sequence, std::shared_ptr<const VertexTriangles> around,
                             double begin, double end)
    : sequence_(std::move(sequence)), around_(std::move(around)), after_{{}, sequence_->triangles} {
  move_to(begin, end);
}

void DeformingMesh::move_to(double begin, double end) {
  begin_ = begin;
  end_ = end;
  sequence_->positions(sequence_->at(begin), before_);
  sequence_->positions(sequence_->at(end), after_.vertices);
  largest_displacement_ = std::sqrt((after_.vertices - before_).colwise().squaredNorm().maxCoeff());
}

Vector3 DeformingMesh::displacement(Index triangle, const Vector3& weights) const {
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Index vertex = after_.triangles(k, triangle);
    sum += weights[k] * (after_.vertices.col(vertex) - before_.col(vertex));
  }
  return sum;
}

Vector3 DeformingMesh::displacement(Index triangle, const Vector3& weights, double t, double t_end) const {
  const MeshSequence::Moment begin = sequence_->at(t);
  const MeshSequence::Moment end = sequence_->at(t_end);
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Index vertex = after_.triangles(k, triangle);
    sum += weights[k] * (sequence_->position(vertex, end) - sequence_->position(vertex, begin));
  }
  return sum;
}

SurfaceMotion DeformingMesh::motion(Index triangle, const Vector3& point) const {
  const auto corner = after_.triangles.col(triangle);
  const Vector3 a = before_.col(corner[0]);
  const Vector3 b = before_.col(corner[1]);
  const Vector3 c = before_.col(corner[2]);
  const Vector3 weights = barycentric(closest_point_on_triangle(point, a, b, c), a, b, c);
  const auto axes = [&](const Points& vertices) {
    const Vector3 origin = vertices.col(corner[0]);
    Matrix3 columns;
    columns << vertices.col(corner[1]) - origin, vertices.col(corner[2]) - origin,
        area_normal(origin, vertices.col(corner[1]), vertices.col(corner[2])).normalized();
    return columns;
  };
  SurfaceMotion motion{.after = point + displacement(triangle, weights), .linear = axes(after_.vertices) * axes(before_).inverse()};
  if (!motion.linear.allFinite()) motion.linear.setIdentity();  // the triangle has no area
  return motion;
}

Vector3 DeformingMesh::face_normal(Index triangle) const {
  const Vector3 own = area_normal(after_, triangle);
  if (own.squaredNorm() > 0.0) return own.normalized();
  Vector3 around = Vector3::Zero();
  for (int corner = 0; corner < 3; ++corner) around += normal_at(triangle, static_cast<TriangleFeature>(corner));
  return around.squaredNorm() > 0.0 ? around.normalized() : Vector3::UnitY();
}

}  // namespace sprung
