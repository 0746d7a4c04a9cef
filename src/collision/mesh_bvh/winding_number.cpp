#include "collision/mesh_bvh/winding_number.h"

#include "base/kernel.h"
#include "collision/core/float_box.h"
#include "collision/mesh_bvh/traversal_stack.h"
#include "geometry/queries/side_of_plane.h"

#include <array>
#include <limits>

namespace sprung {

namespace {

using Vector2 = Eigen::Vector2d;
using TriangleCorners = std::array<Vector3, 3>;

SPRUNG_KERNEL void push_intersecting(const MeshBvh::Node& node, const FloatBox& box, TraversalStack& stack) {
  Float8 apart = {};
  for (int axis = 0; axis < 3; ++axis) {
    const auto outside = (node.min[axis] > box.max[axis]) | (node.max[axis] < box.min[axis]);
    apart = outside ? Float8{} + 1.0F : apart;
  }
  stack.push_within(apart, node.child, 0.0F);
}

template <class Visit>
void visit_box(const MeshBvh& tree, const Box3& box, const Visit& visit) {
  const FloatBox bounds = float_box(box);
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.child < 0) {
      const TrianglePacket& block = tree.block(~entry.child);
      for (unsigned lanes = triangles_in_box(block, box); lanes != 0;) {
        const int lane = pop_lane(lanes);
        visit(block.triangle[lane], block.corners(lane));
      }
    } else {
      push_intersecting(tree.node(entry.child), bounds, stack);
    }
  }
}

/// Contribution of the edge from a to b to the winding number around p in the plane, with p displaced by an infinitesimal amount,
/// so that it is on no line and no point.
int winding_of_edge(const Vector2& a, const Vector2& b, const Vector2& p) {
  if (a.y() <= p.y() && b.y() > p.y()) return side_of_line(a, b, p) > 0.0 ? 1 : 0;
  if (b.y() <= p.y() && a.y() > p.y()) return side_of_line(b, a, p) > 0.0 ? -1 : 0;
  return 0;
}

/// 1 if the ray from p along x leaves through the triangle, -1 if it enters, 0 if it misses.
int crossing_sign(const TriangleCorners& corners, const Vector3& p) {
  const auto along_x = [](const Vector3& q) { return Vector2(q.y(), q.z()); };
  const Vector2 a = along_x(corners[0]);
  const Vector2 b = along_x(corners[1]);
  const Vector2 c = along_x(corners[2]);
  const Vector2 q = along_x(p);
  const int winding = winding_of_edge(a, b, q) + winding_of_edge(b, c, q) + winding_of_edge(c, a, q);
  if (winding == 0) return 0;
  const bool ahead = winding * side_of_plane(corners[0], corners[1], corners[2], p) < 0.0;
  return ahead ? winding : 0;
}

}  // namespace

int winding_number(const MeshBvh& tree, const Vector3& p) {
  Box3 ray(p, p);
  ray.max().x() = std::numeric_limits<double>::infinity();
  int winding = 0;
  visit_box(tree, ray, [&](Index /*triangle*/, const TriangleCorners& corners) { winding += crossing_sign(corners, p); });
  return winding;
}

void find_in_box(const MeshBvh& tree, const Box3& box, std::vector<Index>& found) {
  found.clear();
  visit_box(tree, box, [&](Index triangle, const TriangleCorners& /*corners*/) { found.push_back(triangle); });
}

}  // namespace sprung
