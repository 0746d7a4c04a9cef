// A mesh sequence within one interval, and the tree over its triangles.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/pseudonormal.h"
#include "geometry/mesh/topology.h"

#include <memory>
#include <mutex>
#include <optional>

namespace sprung {

/// The affine motion of a surface near one of its points. In the plane of the triangle, points are stretched and rotated with the
/// surface; their height above it does not change.
struct SurfaceMotion {
  Vector3 after = Vector3::Zero();       ///< of the point, at the end of the interval [m]
  Matrix3 linear = Matrix3::Identity();  ///< maps directions at its begin to those at its end
};

/// A mesh whose vertices move along straight lines within an interval, between their positions in the sequence at its begin and
/// end.
class DeformingMesh {
 public:
  /// In the interval from `begin` to `end` [s]. Requires a sequence with frames and triangles, and the triangles around its
  /// vertices.
  DeformingMesh(std::shared_ptr<const MeshSequence> sequence, std::shared_ptr<const VertexTriangles> around, double begin,
                double end);

  /// Another interval; reuses the memory. Not thread-safe.
  void move_to(double begin, double end);

  /// Positions of the vertices at the interval's begin and end [m].
  [[nodiscard]] const Points& before() const { return before_; }
  [[nodiscard]] const Points& after() const { return after_.vertices; }
  [[nodiscard]] const Triangles& triangles() const { return after_.triangles; }

  /// The largest displacement of a vertex in the interval [m].
  [[nodiscard]] double largest_displacement() const { return largest_displacement_; }

  /// The interval's begin and end [s].
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return end_; }

  /// Displacement [m] of a point of a triangle, given by the weights of its corners: in the interval, or from time t to t_end [s].
  [[nodiscard]] Vector3 displacement(Index triangle, const Vector3& weights) const;
  [[nodiscard]] Vector3 displacement(Index triangle, const Vector3& weights, double t, double t_end) const;

  /// The motion in the interval of the surface near the point of the triangle that is closest to `point`.
  [[nodiscard]] SurfaceMotion motion(Index triangle, const Vector3& point) const;

  // Normals at the interval's end.
  [[nodiscard]] Vector3 normal_at(Index triangle, TriangleFeature feature) const {
    return pseudonormal(after_, *around_, triangle, feature);
  }
  /// Unit length. A triangle without area has the mean of the normals at its corners.
  [[nodiscard]] Vector3 face_normal(Index triangle) const;

 private:
  std::shared_ptr<const MeshSequence> sequence_;
  std::shared_ptr<const VertexTriangles> around_;
  Points before_;
  TriangleMesh after_;
  double largest_displacement_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
};

/// The path of the vertices between two frames is divided into segments, about as long as an edge. The boxes of an interval between
/// two frames contain the whole segments around it, so most intervals have the boxes of the one before: the boxes that were fitted
/// last are kept. Thread-safe. What is kept changes no result, as the interval alone decides the boxes.
class SequenceTree {
 public:
  /// The tree is built from the first frame, so a simulation that starts later uses the same tree. Requires a sequence with frames
  /// and triangles.
  explicit SequenceTree(std::shared_ptr<const MeshSequence> sequence);

  [[nodiscard]] DeformingMesh mesh(double begin, double end) const { return {sequence_, around_, begin, end}; }

  /// Replaces `tree` by the tree with boxes that contain each triangle throughout the interval of `mesh`; reuses its memory. The
  /// positions of its triangles are unspecified.
  void fit(const DeformingMesh& mesh, std::optional<MeshBvh>& tree) const;

 private:
  /// Segments `first` up to and without `last` of the `segments` between `frame` and `next`.
  struct Span {
    Index frame = kNone;
    Index next = kNone;
    int segments = 0;
    int first = 0;
    int last = 0;

    bool operator==(const Span&) const = default;
  };
  [[nodiscard]] int segment_count(Index frame, Index next) const;
  [[nodiscard]] Points positions(const Span& span, int segment) const;

  std::shared_ptr<const MeshSequence> sequence_;
  std::shared_ptr<const VertexTriangles> around_;
  double edge_length_;  ///< mean, in the first frame [m]
  mutable std::mutex mutex_;
  mutable MeshBvh fitted_;  ///< to last_
  mutable Span last_;
};

}  // namespace sprung
