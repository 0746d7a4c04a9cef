#include "collision/shapes/sequence_tree.h"

#include <algorithm>
#include <cmath>

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
