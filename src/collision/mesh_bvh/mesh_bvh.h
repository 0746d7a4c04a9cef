// Bounding volume hierarchy (BVH) of a triangle mesh, with the queries that contact needs: the nearest triangle, and the first
// triangle on a path.
#pragma once

#include "base/types.h"
#include "collision/mesh_bvh/triangle_packet.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/queries/closest_point.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace sprung {

/// Which crossings of a path count: from either side, or only those from the front of a triangle, where (v - u) x (w - u) points
/// to.
enum class CrossingSides : std::uint8_t { both, front };

/// The fraction in [0, 1] at which the path from a to b crosses the closed triangle (u, v, w), or nothing. Decided by exact signs
/// of volumes. A point on an edge or a vertex belongs to every triangle with that edge or vertex, so a path cannot pass between
/// neighbours. A path that ends on the triangle crosses it. A path that begins on it crosses with `front` if it ends behind it,
/// and never with `both`. A path within the triangle's plane does not cross it, and no path crosses a triangle without area.
[[nodiscard]] std::optional<double> crossing_fraction(const Vector3& a, const Vector3& b, const Vector3& u, const Vector3& v,
                                                      const Vector3& w, CrossingSides sides);

class WideBvhCollapse;

/// FCL builds a binary tree of AABBs. The queries read a copy of it, with up to eight children per node and boxes in single
/// precision, rounded outward. Requires a valid mesh: at least one triangle, indices in range, positions below 1e18 [m], so that
/// squares fit single precision. A mesh that deforms keeps the tree of its first positions; only the boxes and the triangles
/// change. Copies share the tree, and the boxes until one of them is refitted.
///
/// Node 0 is the root, and each node comes before its children. Each triangle is in one block. Each block, and each node except
/// the root, is the child of one node.
class MeshBvh {
 public:
  explicit MeshBvh(const TriangleMesh& mesh);

  /// Fits all boxes to contain their triangles while every vertex is between `from` and `to` [m]. Requires the triangles of the
  /// tree.
  void refit(const Triangles& triangles, const Points& from, const Points& to);

  /// Sets the positions of the triangles, which must be within the boxes. Requires the triangles of the tree.
  void set_positions(const Points& vertices, const Triangles& triangles);

  /// The box around all boxes [m].
  [[nodiscard]] const Box3& bounds() const { return bounds_; }

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

  /// FCL's model of the mesh that the tree was built from, for the broad phase.
  [[nodiscard]] const std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>>& model() const { return topology_->model; }

  /// Boxes around the children, one lane per child. A child is the number of a node, or ~i for block i. A lane without a child is 0
  /// and has an empty box.
  struct alignas(64) Node {
    Float8 min[3];
    Float8 max[3];
    std::int32_t child[kFloatSimdWidth];
  };

  // For traversals.
  [[nodiscard]] const Node& node(std::int32_t i) const { return nodes_.get()[i]; }
  [[nodiscard]] const TrianglePacket& block(std::int32_t i) const { return blocks_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::size_t stack_size() const { return topology_->stack_size; }  ///< upper bound of the entries in a traversal
  [[nodiscard]] double magnitude() const { return magnitude_; }                   ///< largest absolute coordinate [m]
  [[nodiscard]] std::array<Vector3, 3> corners(Index triangle) const;

 private:
  /// The block and the lane that contain a triangle.
  struct Slot {
    std::int32_t block;
    int lane;
  };
  /// What copies share.
  struct Topology {
    std::shared_ptr<fcl::BVHModel<fcl::AABB<double>>> model;
    std::size_t node_count = 0;
    std::vector<Slot> slots;  ///< of each triangle
    std::size_t stack_size = 0;
  };

  std::int32_t add_node(const WideBvhCollapse& collapse, int volume, int depth, Topology& topology, std::vector<Node>& nodes);
  std::int32_t add_block(int volume, Topology& topology);
  /// Fits the nodes' boxes, and makes them those of the tree.
  void fit_boxes(const Triangles& triangles, const Points& from, const Points& to, std::vector<Node> nodes);

  std::shared_ptr<const Topology> topology_;
  const Slot* slots_ = nullptr;        ///< those of the topology, at hand for queries
  std::shared_ptr<const Node> nodes_;  ///< the first of them
  std::vector<TrianglePacket> blocks_;
  Box3 bounds_;
  double magnitude_ = 0.0;
};

/// How often a closed mesh of outward triangles winds around p: 0 outside, 1 inside, more where components overlap. Exact if p is
/// not on the mesh: exact signs decide which triangles the ray from p along x crosses, and a ray through an edge or a vertex
/// passes it on the same side for all its triangles.
[[nodiscard]] int winding_number(const MeshBvh& tree, const Vector3& p);

/// Replaces `found` by the triangles whose boxes intersect the box. May include some whose boxes are only close to it.
void find_in_box(const MeshBvh& tree, const Box3& box, std::vector<Index>& found);

}  // namespace sprung
