// Bounding volume hierarchy (BVH) of a triangle mesh, with the queries that contact needs: the nearest triangle, and the first
// triangle on a path.
#pragma once

#include "collision/mesh_bvh/segment_triangle_crossing.h"
#include "collision/mesh_bvh/triangle_packet.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/queries/closest_point.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace sprung {

class WideBvhCollapse;

/// FCL builds a binary tree of AABBs. The queries read a copy of it, with up to eight children per node and boxes in single
/// precision, rounded outward. Requires a valid mesh: at least one triangle, indices in range, positions below 1e18 [m], so that
/// squares fit single precision. A mesh that deforms keeps the tree of its first positions; only the boxes and the triangles
/// change.
///
/// Node 0 is the root, and each node comes before its children. Each triangle is in one block. Each block, and each node except
/// the root, is the child of one node.
class MeshBvh {
 public:
  explicit MeshBvh(const TriangleMesh& mesh);

  /// Refits all boxes, FCL's and the copy's, so that each contains its triangles while every vertex is between `from` and `to`
  /// [m]. Not thread-safe.
  void refit(const Points& from, const Points& to);

  /// Copies the boxes of `refitted`, a copy of this tree after refit().
  void take_boxes(const MeshBvh& refitted);

  /// Sets the positions of the triangles, which must be within the boxes. Requires the triangles of the tree. Not thread-safe.
  void set_positions(const TriangleMesh& mesh);

  /// The box around all boxes [m].
  [[nodiscard]] Box3 bounds() const;

  struct Nearest {
    Index triangle = kNone;
    ClosestPoint closest;
    std::array<Vector3, 3> corners;  ///< of the triangle
  };
  /// The triangle nearest to p, if nearer than `radius` [m]. If several are equally near, the choice is deterministic.
  [[nodiscard]] std::optional<Nearest> nearest(const Vector3& p, double radius) const;

  struct Hit {
    Index triangle = kNone;
    double fraction = 0.0;  ///< of the path, in [0, 1]
  };
  /// The first triangle that the path from a to b crosses, by exact predicates: no crossing is missed, and edges and vertices
  /// belong to all their triangles. Of triangles crossed at the same fraction, the one with the lowest index.
  [[nodiscard]] std::optional<Hit> first_hit(const Vector3& a, const Vector3& b, CrossingSides sides) const;

  /// FCL's model, for the broad phase.
  [[nodiscard]] const std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>>& model() const { return model_; }

  /// Boxes around the children, one lane per child. A child is the number of a node, or ~i for block i. A lane without a child has
  /// an empty box.
  struct alignas(64) Node {
    Float8 min[3];
    Float8 max[3];
    std::int32_t child[kFloatSimdWidth];
  };

  // For traversals.
  [[nodiscard]] const Node& node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const TrianglePacket& block(std::int32_t i) const { return blocks_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::size_t stack_size() const { return stack_size_; }  ///< upper bound of the entries in a traversal
  [[nodiscard]] double magnitude() const { return magnitude_; }         ///< largest absolute coordinate [m]
  [[nodiscard]] std::array<Vector3, 3> corners(Index triangle) const;

 private:
  /// For each lane of a node, the number of FCL's bounding volume; kNone for a lane without one.
  using Volumes = std::array<Index, kFloatSimdWidth>;

  /// The block and the lane that contain a triangle.
  struct Slot {
    std::int32_t block;
    int lane;
  };

  std::int32_t add_node(const WideBvhCollapse& collapse, int volume, int depth);
  std::int32_t add_block(int volume);
  void fit_boxes(std::size_t node);

  std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>> model_;
  std::vector<Node> nodes_;
  std::vector<Volumes> volumes_;  ///< of each node
  std::vector<TrianglePacket> blocks_;
  std::vector<Slot> slots_;  ///< of each triangle
  std::size_t stack_size_ = 0;
  double magnitude_ = 0.0;
};

}  // namespace sprung
