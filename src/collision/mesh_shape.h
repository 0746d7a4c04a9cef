// A triangle mesh as an obstacle's shape.
#pragma once

#include "collision/mesh_tree.h"
#include "collision/obstacle_shape.h"
#include "geometry/pseudonormal.h"

namespace sprung {

class MeshShape final : public ObstacleShape {
 public:
  /// Throws InputError, naming every problem, for a mesh that FCL must not see: none, without triangles, with a position that is
  /// not finite or with an index out of range.
  explicit MeshShape(const MeshGeometry& geometry);

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const override;
  [[nodiscard]] std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const override;
  [[nodiscard]] bool contains(const Vector3& p) const override;
  [[nodiscard]] Box3 bounds() const override { return bounds_; }
  [[nodiscard]] double magnitude() const override { return magnitude_; }
  [[nodiscard]] double rounding(const Vector3& p) const override;

  [[nodiscard]] const MeshTree& tree() const { return *tree_; }

 private:
  [[nodiscard]] SurfacePoint surface_point(const Vector3& p, const MeshTree::Nearest& found) const;

  std::shared_ptr<const TriangleMesh> mesh_;
  bool closed_;
  Box3 bounds_;
  double magnitude_ = 0.0;
  std::optional<MeshTree> tree_;
  Pseudonormals pseudonormals_;
};

}  // namespace sprung
