#include "collision/element_bvh/vertex_face_filter.h"

#include "base/kernel.h"

namespace sprung {
namespace {

using IntLanes = ElementBvhLeaf::IntLanes;
using Vector3Lanes = Float8[3];

inline void subtract(const Vector3Lanes& a, const Vector3Lanes& b, float scale, Vector3Lanes& result) {
  for (int axis = 0; axis < 3; ++axis) result[axis] = scale * (a[axis] - b[axis]);
}

inline void cross(const Vector3Lanes& a, const Vector3Lanes& b, Vector3Lanes& result) {
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

inline void dot(const Vector3Lanes& a, const Vector3Lanes& b, Float8& result) { result = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline void subtract(const float (&a)[3], const Vector3Lanes& b, float scale, Vector3Lanes& result) {
  for (int axis = 0; axis < 3; ++axis) result[axis] = scale * (a[axis] - b[axis]);
}

}  // namespace

SPRUNG_KERNEL bool find_faces(const MovingVertex& vertex, const ElementBvhLeaf& leaf, const LeafCorners& corners, LaneBytes& hits) {
  // Lengths are scaled by `aside`, so that their powers neither overflow nor underflow.
  const float scale = 1.0F / vertex.aside;
  const float reach = scale * vertex.reach;
  Vector3Lanes edge[3];
  for (int k = 0; k < 3; ++k) subtract(corners.now[(k + 1) % 3], corners.now[k], scale, edge[k]);
  Vector3Lanes normal;
  cross(edge[0], edge[1], normal);
  Float8 area2;
  dot(normal, normal, area2);

  Vector3Lanes begin;
  Vector3Lanes end;
  Vector3Lanes displacement;
  subtract(vertex.now, corners.now[0], scale, begin);
  subtract(vertex.end, corners.end[0], scale, end);
  subtract(end, begin, 1.0F, displacement);
  Float8 low;
  Float8 high;
  dot(begin, normal, low);
  dot(end, normal, high);
  const Float8 rise = high - low;
  const Float8 nearest2 = low * low < high * high ? low * low : high * high;
  const Float8 reach2 = reach * reach * area2;
  IntLanes may_touch = leaf.is_triangle & ((nearest2 <= reach2) | (low * high <= 0.0F));
  for (const auto& particle : leaf.particle) may_touch &= particle != vertex.particle;
  store(may_touch, hits);
  if (!any(hits)) return false;

  // The limit is (1 + d)^2 <= 2 + 2 d^2 with the displacement d along the triangle, times the squared area.
  Float8 displacement2;
  dot(displacement, displacement, displacement2);
  const Float8 aside2 = 2.0F * (1.0F + displacement2) * area2 - 2.0F * rise * rise;
  for (int k = 0; k < 3; ++k) {
    Vector3Lanes from;
    Vector3Lanes turn;
    Float8 inward;
    Float8 length2;
    subtract(vertex.now, corners.now[k], scale, from);
    cross(edge[k], from, turn);
    dot(turn, normal, inward);
    dot(edge[k], edge[k], length2);
    may_touch &= (inward >= 0.0F) | (inward * inward <= aside2 * length2);
  }
  store(may_touch, hits);
  return any(hits);
}

}  // namespace sprung
