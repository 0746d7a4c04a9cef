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

SPRUNG_KERNEL bool find_faces(const MovingVertex& corner, const ElementBvhLeaf& leaf, const LeafBounds& places, LaneBytes& met) {
  // In units of `aside`, so that powers of lengths neither over- nor underflow.
  const float scale = 1.0F / corner.aside;
  const float reach = scale * corner.reach;
  Vector3Lanes edge[3];
  for (int k = 0; k < 3; ++k) subtract(places.now[(k + 1) % 3], places.now[k], scale, edge[k]);
  Vector3Lanes normal;
  cross(edge[0], edge[1], normal);
  Float8 area2;
  dot(normal, normal, area2);

  Vector3Lanes begin;
  Vector3Lanes end;
  Vector3Lanes way;
  subtract(corner.now, places.now[0], scale, begin);
  subtract(corner.end, places.end[0], scale, end);
  subtract(end, begin, 1.0F, way);
  Float8 low;
  Float8 high;
  dot(begin, normal, low);
  dot(end, normal, high);
  const Float8 rise = high - low;
  const Float8 nearest2 = low * low < high * high ? low * low : high * high;
  const Float8 reach2 = reach * reach * area2;
  IntLanes meets = leaf.is_triangle & ((nearest2 <= reach2) | (low * high <= 0.0F));
  for (const auto& particle : leaf.particle) meets &= particle != corner.particle;
  store(meets, met);
  if (!any(met)) return false;

  // (1 + way along)^2 <= 2 + 2 (way along)^2, times the area's square.
  Float8 way2;
  dot(way, way, way2);
  const Float8 aside2 = 2.0F * (1.0F + way2) * area2 - 2.0F * rise * rise;
  for (int k = 0; k < 3; ++k) {
    Vector3Lanes from;
    Vector3Lanes turn;
    Float8 inward;
    Float8 length2;
    subtract(corner.now, places.now[k], scale, from);
    cross(edge[k], from, turn);
    dot(turn, normal, inward);
    dot(edge[k], edge[k], length2);
    meets &= (inward >= 0.0F) | (inward * inward <= aside2 * length2);
  }
  store(meets, met);
  return any(met);
}

}  // namespace sprung
