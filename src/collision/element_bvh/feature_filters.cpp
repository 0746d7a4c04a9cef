#include "collision/element_bvh/feature_filters.h"

#include "base/machine/kernel.h"

namespace sprung {
namespace {

using IntLanes = ElementBvhLeaf::IntLanes;
using Vector3Lanes = Float8[3];

// Lanes are passed by reference: by value, the calling convention would depend on the instruction set.

inline void lower(Float8& a, const Float8& b) { a = a < b ? a : b; }
inline void raise(Float8& a, const Float8& b) { a = a > b ? a : b; }

inline void dot(const Vector3Lanes& a, const Vector3Lanes& b, Float8& result) { result = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline void clamp(Float8& x) {
  x = x > 0.0F ? x : Float8{};
  x = x < 1.0F ? x : Float8{} + 1.0F;
}

/// Lanes that are more than `reach` above or below the edge along an axis.
inline void find_apart(const float (&a)[2][3], const Float8 (&b)[2][3], const Float8& reach, int axis, IntLanes& above,
                       IntLanes& below) {
  Float8 low = b[0][axis];
  Float8 high = low;
  lower(low, b[1][axis]);
  raise(high, b[1][axis]);
  const float own_low = a[0][axis] < a[1][axis] ? a[0][axis] : a[1][axis];
  const float own_high = a[0][axis] < a[1][axis] ? a[1][axis] : a[0][axis];
  above = own_low - high > reach;
  below = low - own_high > reach;
}

/// The vector from the lanes' closest points to the edge's, in units of 1 / scale. For nearly parallel edges the points are only
/// close to the closest ones.
inline void find_separation(const MovingEdge& edge, const EdgeLanes& lanes, float scale, Vector3Lanes& separation) {
  float along_a[3];
  Vector3Lanes along_b;
  Vector3Lanes between;
  for (int axis = 0; axis < 3; ++axis) {
    along_a[axis] = scale * (edge.now[1][axis] - edge.now[0][axis]);
    along_b[axis] = scale * (lanes.now[1][axis] - lanes.now[0][axis]);
    between[axis] = scale * (edge.now[0][axis] - lanes.now[0][axis]);
  }
  const float aa = along_a[0] * along_a[0] + along_a[1] * along_a[1] + along_a[2] * along_a[2];
  const Float8 from_a = along_a[0] * between[0] + along_a[1] * between[1] + along_a[2] * between[2];
  const Float8 ab = along_a[0] * along_b[0] + along_a[1] * along_b[1] + along_a[2] * along_b[2];
  Float8 bb;
  Float8 from_b;
  dot(along_b, along_b, bb);
  dot(along_b, between, from_b);
  const Float8 sine2 = aa * bb - ab * ab;
  Float8 s = sine2 > 0.0F ? (ab * from_b - from_a * bb) / sine2 : Float8{};
  clamp(s);
  Float8 t = bb > 0.0F ? (ab * s + from_b) / bb : Float8{};
  clamp(t);
  s = aa > 0.0F ? (t * ab - from_a) / (Float8{} + aa) : Float8{};
  clamp(s);
  for (int axis = 0; axis < 3; ++axis) separation[axis] = between[axis] + s * along_a[axis] - t * along_b[axis];
}

/// The gap between the edge and the lanes along a direction; negative where they overlap.
inline void find_gap(const float (&a)[2][3], const Float8 (&b)[2][3], const Vector3Lanes& direction, float scale, Float8& gap) {
  Float8 height[4];
  for (int k = 0; k < 2; ++k) {
    Vector3Lanes own;
    Vector3Lanes other;
    for (int axis = 0; axis < 3; ++axis) {
      own[axis] = scale * (a[k][axis] - b[0][axis]);
      other[axis] = scale * (b[k][axis] - b[0][axis]);
    }
    dot(own, direction, height[k]);
    dot(other, direction, height[2 + k]);
  }
  lower(height[0], height[1]);
  raise(height[2], height[3]);
  gap = height[0] - height[2];
}

inline void subtract(const Vector3Lanes& a, const Vector3Lanes& b, float scale, Vector3Lanes& result) {
  for (int axis = 0; axis < 3; ++axis) result[axis] = scale * (a[axis] - b[axis]);
}

inline void cross(const Vector3Lanes& a, const Vector3Lanes& b, Vector3Lanes& result) {
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

inline void subtract(const float (&a)[3], const Vector3Lanes& b, float scale, Vector3Lanes& result) {
  for (int axis = 0; axis < 3; ++axis) result[axis] = scale * (a[axis] - b[axis]);
}

}  // namespace

MovingEdge moving_edge(const EdgeLanes& lanes, int lane, float reach) {
  MovingEdge edge;
  for (int k = 0; k < 2; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      edge.now[k][axis] = lanes.now[k][axis][lane];
      edge.end[k][axis] = lanes.end[k][axis][lane];
    }
    edge.particle[k] = lanes.particle[k][lane];
  }
  edge.marked = lanes.marked[lane] != 0;
  edge.reach = reach;
  edge.radius = lanes.radius[lane];
  return edge;
}

SPRUNG_KERNEL bool find_edges(const MovingEdge& edge, const EdgeLanes& lanes, LaneBytes& hits) {
  IntLanes may_touch = lanes.used;
  if (!edge.marked) may_touch &= lanes.marked;
  for (const auto& particle : lanes.particle) may_touch &= (particle != edge.particle[0]) & (particle != edge.particle[1]);
  const Float8 reach = edge.reach + edge.radius + lanes.radius;
  for (int axis = 0; axis < 3; ++axis) {
    IntLanes above[2];
    IntLanes below[2];
    find_apart(edge.now, lanes.now, reach, axis, above[0], below[0]);
    find_apart(edge.end, lanes.end, reach, axis, above[1], below[1]);
    may_touch &= ~((above[0] & above[1]) | (below[0] & below[1]));
  }
  store(may_touch, hits);
  if (!any(hits)) return false;

  // Lengths are scaled by about the reach, so that their powers neither overflow nor underflow.
  const float scale = 1.0F / (edge.reach + edge.radius);
  Vector3Lanes separation;
  find_separation(edge, lanes, scale, separation);
  Float8 gap;
  Float8 gap_at_end;
  find_gap(edge.now, lanes.now, separation, scale, gap);
  find_gap(edge.end, lanes.end, separation, scale, gap_at_end);
  lower(gap, gap_at_end);
  Float8 length2;
  dot(separation, separation, length2);
  const Float8 scaled = scale * reach;
  may_touch &= ~((gap > 0.0F) & (gap * gap > scaled * scaled * length2));
  store(may_touch, hits);
  return any(hits);
}

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
