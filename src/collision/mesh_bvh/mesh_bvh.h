// FCL's bounding volume tree of a mesh, and the walks that contact needs: nearest triangle, first triangle on a path.
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

/// FCL builds the tree of AABBs; a copy of it with up to eight children a node and single-precision boxes, rounded outward, is what
/// the walks read. Requires a valid mesh: at least one triangle, indices in range, positions below 1e18 [m] (squares of single
/// precision). A mesh that deforms keeps the tree of its first positions; only its boxes and triangles follow.
///
/// Node 0 is the root, and a node comes before its children. Each triangle is in one block; each block, and each node but the root,
/// is the child of one node.
class MeshBvh {
 public:
  explicit MeshBvh(const TriangleMesh& mesh);

  /// Refits all boxes, FCL's and the copy's, so that each holds its triangles while every vertex is between `from` and `to` [m].
  /// Not thread-safe.
  void refit(const Points& from, const Points& to);

  /// Takes over the boxes of a copy that was refitted.
  void take_boxes(const MeshBvh& refitted);

  /// Where the triangles are from now on, within the boxes. Requires the triangles of the tree. Not thread-safe.
  void place(const TriangleMesh& mesh);

  /// The box around all boxes [m].
  [[nodiscard]] Box3 bounds() const;

  struct Nearest {
    Index triangle = kNone;
    ClosestPoint closest;
    std::array<Vector3, 3> corners;  ///< of the triangle
  };
  /// The triangle nearest to p, if nearer than `radius` [m]. Of equally near ones always the same.
  [[nodiscard]] std::optional<Nearest> nearest(const Vector3& p, double radius) const;

  struct Hit {
    Index triangle = kNone;
    double fraction = 0.0;  ///< of the path, in [0, 1]
  };
  /// The first triangle that the path from a to b meets, judged by exact predicates: none is missed, edges and vertices belong to
  /// all their triangles. Of triangles met at the same fraction the lowest index.
  [[nodiscard]] std::optional<Hit> first_hit(const Vector3& a, const Vector3& b, CrossingSides sides) const;

  /// FCL's model, for its broad phase.
  [[nodiscard]] const std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>>& model() const { return model_; }

  /// Boxes around the children, a lane a child: a node's number, or ~i for block i. Double4 without a child have an empty box.
  struct alignas(64) Node {
    Float8 min[3];
    Float8 max[3];
    std::int32_t child[kFloatSimdWidth];
  };

  // What walks read.
  [[nodiscard]] const Node& node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const TrianglePacket& block(std::int32_t i) const { return blocks_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::size_t stack_size() const { return stack_size_; }  ///< entries that no walk outgrows
  [[nodiscard]] double magnitude() const { return magnitude_; }         ///< largest absolute coordinate [m]
  [[nodiscard]] std::array<Vector3, 3> corners(Index triangle) const;

 private:
  /// For each lane of a node FCL's number of its bounding volume; kNone where there is none.
  using Volumes = std::array<Index, kFloatSimdWidth>;

  /// Where a triangle is.
  struct Place {
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
  std::vector<Place> places_;  ///< of each triangle
  std::size_t stack_size_ = 0;
  double magnitude_ = 0.0;
};

}  // namespace sprung
