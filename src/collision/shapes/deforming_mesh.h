// A mesh sequence during one interval.
#pragma once

#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/pseudonormal.h"
#include "geometry/mesh/topology.h"

#include <memory>

namespace sprung {

/// Where a point of a surface goes, and what becomes of what lies around it: what is beside it is stretched and turned as the
/// surface is, what is above it stays as high.
struct SpotMotion {
  Vector3 after = Vector3::Zero();
  Matrix3 turn = Matrix3::Identity();
};

/// Within an interval each vertex moves straight from where the sequence has it at the begin to where it has it at the end.
class DeformingMesh {
 public:
  /// Requires a sequence with frames and triangles. It is nowhere before the first interval is set.
  explicit DeformingMesh(std::shared_ptr<const MeshSequence> sequence);

  /// Not thread-safe.
  void set_interval(double t, double t_end);

  /// The mesh at the interval's begin and end.
  [[nodiscard]] const TriangleMesh& before() const { return before_; }
  [[nodiscard]] const TriangleMesh& after() const { return after_; }

  /// Positions between which every vertex stays throughout the interval. Those around all of a part of the way from one frame to
  /// the next, where the interval is within it, so that they seldom change; parts are as long as it takes to go as far as edges are
  /// long.
  struct Sweep {
    const Points& from;
    const Points& to;
  };
  [[nodiscard]] Sweep sweep() const;
  /// Whether the sweep is another than that of the interval before.
  [[nodiscard]] bool sweep_is_new() const { return sweep_is_new_; }

  /// The farthest that a vertex moves in the interval [m].
  [[nodiscard]] double largest_displacement() const { return largest_displacement_; }

  /// The interval's begin and end [s].
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return end_; }

  /// How far a point of a triangle, given by the weights of its corners, moves in the interval, or from time t to t_end [m].
  [[nodiscard]] Vector3 displacement(Index triangle, const Vector3& weights) const;
  [[nodiscard]] Vector3 displacement(Index triangle, const Vector3& weights, double t, double t_end) const;

  /// How a triangle takes along what is at and around a point of its own in the interval.
  [[nodiscard]] SpotMotion motion(Index triangle, const Vector3& point) const;

  // Normals at the interval's end.
  [[nodiscard]] Vector3 normal_at(Index triangle, TriangleFeature feature) const {
    return pseudonormal(after_, around_, triangle, feature);
  }
  /// Unit length; a triangle without area has the one of its surroundings.
  [[nodiscard]] Vector3 face_normal(Index triangle) const;

 private:
  std::shared_ptr<const MeshSequence> sequence_;
  VertexTriangles around_;
  double edge_length_ = 0.0;  ///< mean, in the first frame [m]
  TriangleMesh before_;
  TriangleMesh after_;

  /// From the part that begins at `first` to the one that ends at `last`, of so many from `frame` on to `next`; where there are no
  /// parts, the sweep is from before_ to after_.
  struct Span {
    Index frame = kNone;
    Index next = kNone;
    int parts = 0;
    int first = 0;
    int last = 0;

    bool operator==(const Span&) const = default;
  };
  void fit_span(const MeshSequence::Moment& begin, const MeshSequence::Moment& end);
  [[nodiscard]] int parts_between(Index frame, Index next) const;

  Span span_;
  Points sweep_from_;
  Points sweep_to_;
  bool sweep_is_new_ = false;
  double largest_displacement_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
};

}  // namespace sprung
