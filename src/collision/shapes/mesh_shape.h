// A rigid or deforming triangle mesh as the shape of an obstacle.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/shapes/deforming_mesh.h"
#include "collision/shapes/obstacle_shape.h"
#include "geometry/mesh/pseudonormal.h"

namespace sprung {

class MeshShape final : public ObstacleShape {
 public:
  /// Throws InputError, which names every problem, if the mesh is missing, has no triangles, has a position that is not finite or
  /// has an index out of range.
  explicit MeshShape(const MeshGeometry& geometry);
  /// The sequence at time 0. Throws InputError, which names every problem, if the sequence is missing or has no frames, or if a
  /// frame is invalid as above or differs from the first in its number of vertices.
  explicit MeshShape(const SequenceGeometry& geometry);

  [[nodiscard]] bool deforms() const override { return deforms_; }
  [[nodiscard]] std::shared_ptr<const ObstacleShape> in_interval(double begin, double end) const override;
  [[nodiscard]] double largest_displacement() const override { return deforms_ ? deforming_->largest_displacement() : 0.0; }
  [[nodiscard]] Vector3 displacement(const Vector3& p) const override;
  [[nodiscard]] Vector3 displacement(const Vector3& p, double t, double t_end) const override;
  [[nodiscard]] std::optional<MovedElement> moved_element(const ElementCorners& element) const override;
  [[nodiscard]] std::optional<MovedTriangle> moved_triangle(const Vector3& p) const override;

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const override;
  [[nodiscard]] std::optional<SurfacePoint> nearest_cached(const Vector3& p, double radius, double tolerance,
                                                           SurfaceMemory& memory) const override;
  [[nodiscard]] std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const override;
  void find_region(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) const override;
  void update_closest_points(const ElementCorners& element, const SafeRegionRequest& request, bool fresh,
                             SafeRegion& region) const override;
  bool advance_region(SafeRegion& region) const override;
  [[nodiscard]] bool touches(const ElementCorners& element, double tolerance) const override;
  [[nodiscard]] bool contains(const Vector3& p) const override;
  [[nodiscard]] Box3 bounds() const override { return bounds_; }
  [[nodiscard]] double magnitude() const override { return magnitude_; }
  [[nodiscard]] double rounding(const Vector3& p) const override;

  [[nodiscard]] const MeshBvh& tree() const { return *tree_; }

 private:
  /// Another interval of a sequence.
  MeshShape(const MeshShape& shape, double begin, double end);
  void fit_to(double begin, double end);
  struct Spares;
  void move_with_surface(SafeRegion& region) const;
  static void set_triangle_weights(const MeshBvh& tree, SafeRegion& region);
  /// A point of the surface: a triangle and the weights of its corners.
  struct TrianglePoint {
    Index triangle = kNone;
    Vector3 weights = Vector3::Zero();
  };
  [[nodiscard]] static TrianglePoint nearest_triangle_point(const MeshBvh& tree, const Vector3& p);
  [[nodiscard]] SafeRegion nearest_before(const ElementCorners& element) const;
  [[nodiscard]] Vector3 face_normal(Index triangle) const;
  [[nodiscard]] Vector3 pseudonormal(Index triangle, TriangleFeature feature) const;
  [[nodiscard]] SurfacePoint surface_point(const Vector3& p, const MeshBvh::Nearest& found) const;

  std::shared_ptr<const TriangleMesh> rigid_;     ///< null for a sequence
  std::shared_ptr<const SequenceTree> sequence_;  ///< null for a rigid mesh
  std::shared_ptr<Spares> spares_;                ///< of the shape that makes those of other intervals; else null
  std::optional<DeformingMesh> deforming_;
  bool deforms_ = false;
  bool closed_;
  Box3 bounds_;
  double magnitude_ = 0.0;
  std::optional<MeshBvh> tree_;         ///< at the interval's end
  std::optional<MeshBvh> tree_before_;  ///< at its begin; the same boxes
  Pseudonormals pseudonormals_;         ///< of the rigid mesh
};

}  // namespace sprung
