// A mesh sequence within one interval.
#pragma once

#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/pseudonormal.h"
#include "geometry/mesh/topology.h"

#include <memory>

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
  /// Requires a sequence with frames and triangles. Call set_interval() before any query.
  explicit DeformingMesh(std::shared_ptr<const MeshSequence> sequence);

  /// Not thread-safe.
  void set_interval(double t, double t_end);

  /// The mesh at the interval's begin and end.
  [[nodiscard]] const TriangleMesh& before() const { return before_; }
  [[nodiscard]] const TriangleMesh& after() const { return after_; }

  /// Positions that bound the path of each vertex in the interval. The path between two frames is divided into segments, about as
  /// long as an edge. An interval between two frames has the sweep of the segments that contain it, so the sweep rarely changes.
  struct Sweep {
    const Points& from;
    const Points& to;
  };
  [[nodiscard]] Sweep sweep() const;
  /// Whether the sweep differs from the sweep of the previous interval.
  [[nodiscard]] bool sweep_is_new() const { return sweep_is_new_; }

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
    return pseudonormal(after_, around_, triangle, feature);
  }
  /// Unit length. A triangle without area has the mean of the normals at its corners.
  [[nodiscard]] Vector3 face_normal(Index triangle) const;

 private:
  std::shared_ptr<const MeshSequence> sequence_;
  VertexTriangles around_;
  double edge_length_ = 0.0;  ///< mean, in the first frame [m]
  TriangleMesh before_;
  TriangleMesh after_;

  /// Segments `first` up to and without `last` of the `segments` between `frame` and `next`. Without segments the sweep is from
  /// before_ to after_.
  struct Span {
    Index frame = kNone;
    Index next = kNone;
    int segments = 0;
    int first = 0;
    int last = 0;

    bool operator==(const Span&) const = default;
  };
  void fit_span(const MeshSequence::Moment& begin, const MeshSequence::Moment& end);
  [[nodiscard]] int segment_count(Index frame, Index next) const;

  Span span_;
  Points sweep_from_;
  Points sweep_to_;
  bool sweep_is_new_ = false;
  double largest_displacement_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
};

}  // namespace sprung
