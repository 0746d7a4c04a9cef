// A mesh sequence during one interval.
#pragma once

#include "geometry/mesh_sequence.h"
#include "geometry/pseudonormal.h"
#include "geometry/topology.h"

#include <memory>

namespace sprung {

/// Within an interval each vertex moves straight from where the sequence has it at the begin to where it has it at the end.
class DeformingMesh {
 public:
  /// Requires a sequence with frames and triangles. It is nowhere before the first interval is set.
  explicit DeformingMesh(std::shared_ptr<const MeshSequence> sequence);

  /// Not thread-safe.
  void set_interval(double t, double t_end);

  [[nodiscard]] const MeshSequence& sequence() const { return *sequence_; }

  /// Positions at the interval's begin [m].
  [[nodiscard]] const Points& before() const { return before_; }
  /// The mesh at the interval's end.
  [[nodiscard]] const TriangleMesh& after() const { return after_; }

  /// Positions between which every vertex stays throughout the interval: those of the two frames around it, where there are such,
  /// so that they seldom change.
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

  // Normals at the interval's end.
  [[nodiscard]] Vector3 normal_at(Index triangle, TriangleFeature feature) const {
    return pseudonormal(after_, around_, triangle, feature);
  }
  /// Unit length; a triangle without area has the one of its surroundings.
  [[nodiscard]] Vector3 face_normal(Index triangle) const;

 private:
  std::shared_ptr<const MeshSequence> sequence_;
  VertexTriangles around_;
  Points before_;
  TriangleMesh after_;
  Index first_frame_ = kNone;  ///< of the two around the interval; kNone: it is not between two
  Index last_frame_ = kNone;
  bool sweep_is_new_ = false;
  double largest_displacement_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
};

}  // namespace sprung
