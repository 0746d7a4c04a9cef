#include "collision/deforming_mesh.h"

#include <cmath>
#include <utility>

namespace sprung {

DeformingMesh::DeformingMesh(std::shared_ptr<const MeshSequence> sequence)
    : sequence_(std::move(sequence)),
      around_(triangles_around_vertices(sequence_->triangles, static_cast<Index>(sequence_->frames.front().cols()))),
      after_{{}, sequence_->triangles} {}

void DeformingMesh::set_interval(double t, double t_end) {
  begin_ = t;
  end_ = t_end;
  const MeshSequence::Moment begin = sequence_->at(t);
  const MeshSequence::Moment end = sequence_->at(t_end);
  sequence_->positions(begin, before_);
  sequence_->positions(end, after_.vertices);
  largest_displacement_ = std::sqrt((after_.vertices - before_).colwise().squaredNorm().maxCoeff());

  const bool between_two = end.frame == begin.frame || (end.frame == begin.next && end.part == 0.0);
  const Index first = between_two ? begin.frame : kNone;
  const Index last = between_two ? begin.next : kNone;
  sweep_is_new_ = !between_two || first != first_frame_ || last != last_frame_;
  first_frame_ = first;
  last_frame_ = last;
}

DeformingMesh::Sweep DeformingMesh::sweep() const {
  if (first_frame_ == kNone) return {before_, after_.vertices};
  return {sequence_->frames[first_frame_], sequence_->frames[last_frame_]};
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

Vector3 DeformingMesh::face_normal(Index triangle) const {
  const Vector3 own = area_normal(after_, triangle);
  if (own.squaredNorm() > 0.0) return own.normalized();
  Vector3 around = Vector3::Zero();
  for (int corner = 0; corner < 3; ++corner) around += normal_at(triangle, static_cast<TriangleFeature>(corner));
  return around.squaredNorm() > 0.0 ? around.normalized() : Vector3::UnitY();
}

}  // namespace sprung
