#include "collision/shapes/deforming_mesh.h"

#include "geometry/queries/closest_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung {
namespace {

constexpr double kMaxSegments = 1024.0;

double mean_edge_length(const Points& vertices, const Triangles& triangles) {
  double sum = 0.0;
  for (const auto& corner : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) sum += (vertices.col(corner[(k + 1) % 3]) - vertices.col(corner[k])).norm();
  }
  return sum / static_cast<double>(triangles.size());
}

}  // namespace

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

SequenceTree::SequenceTree(std::shared_ptr<const MeshSequence> sequence)
    : sequence_(std::move(sequence)),
      around_(std::make_shared<const VertexTriangles>(
          triangles_around_vertices(sequence_->triangles, static_cast<Index>(sequence_->frames.front().cols())))),
      edge_length_(mean_edge_length(sequence_->frames.front(), sequence_->triangles)),
      fitted_(TriangleMesh{sequence_->frames.front(), sequence_->triangles}) {}

void SequenceTree::fit(const DeformingMesh& mesh, std::optional<MeshBvh>& tree) const {
  const MeshSequence::Moment begin = sequence_->at(mesh.begin());
  const MeshSequence::Moment end = sequence_->at(mesh.end());
  const bool at_next = end.frame == begin.next && end.fraction == 0.0 && begin.fraction > 0.0;
  const std::lock_guard lock(mutex_);
  if (end.frame != begin.frame && !at_next) {
    tree = fitted_;
    tree->refit(mesh.triangles(), mesh.before(), mesh.after());
    return;
  }
  Span span{.frame = begin.frame, .next = begin.next};
  const bool same_frames = last_.frame == span.frame && last_.next == span.next;
  span.segments = same_frames ? last_.segments : segment_count(span.frame, span.next);
  const double low = std::min(begin.fraction, at_next ? 1.0 : end.fraction);
  const double high = std::max(begin.fraction, at_next ? 1.0 : end.fraction);
  span.first = std::min(static_cast<int>(low * span.segments), span.segments - 1);
  span.last = std::max(static_cast<int>(std::ceil(high * span.segments)), span.first + 1);
  if (span != last_) {
    fitted_.refit(mesh.triangles(), positions(span, span.first), positions(span, span.last));
    last_ = span;
  }
  tree = fitted_;
}

Points SequenceTree::positions(const Span& span, int segment) const {
  if (segment == span.segments) return sequence_->frames[span.next];
  Points positions;
  sequence_->positions({span.frame, span.next, static_cast<double>(segment) / span.segments}, positions);
  return positions;
}

int SequenceTree::segment_count(Index frame, Index next) const {
  const double farthest2 = (sequence_->frames[next] - sequence_->frames[frame]).colwise().squaredNorm().maxCoeff();
  const double segments = std::ceil(std::sqrt(farthest2) / edge_length_);
  return std::isfinite(segments) ? static_cast<int>(std::clamp(segments, 1.0, kMaxSegments)) : 1;
}

}  // namespace sprung
