#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/mesh_bvh/traversal_stack.h"

#include "base/machine/kernel.h"
#include "collision/mesh_bvh/triangle_packet_distance.h"
#include "geometry/queries/side_of_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace sprung {
namespace {

constexpr float kFloatMin = std::numeric_limits<float>::min();
constexpr float kFloatMax = std::numeric_limits<float>::max();

/// A float slightly above the square of a distance. It is finite, so that an empty box, whose distance is infinite, is never
/// nearer.
float bound_of(double squared) {
  return std::min(static_cast<float>(std::min(squared, 1e38)) * (1.0F + 0x1p-22F) + kFloatMin, kFloatMax);
}

/// A position whose coordinates are each between two floats.
struct FloatRange {
  float low[3];
  float high[3];
};

FloatRange float_range(const Vector3& p) {
  FloatRange range;
  for (int axis = 0; axis < 3; ++axis) {
    range.low[axis] = float_below(p[axis]);
    range.high[axis] = float_above(p[axis]);
  }
  return range;
}

/// Lower bounds of the children's squared distances. Rounding makes the squared distance of a box too large by at most 6 times
/// 2^-24, which the factor compensates.
[[gnu::always_inline]] inline void bound_children(const MeshBvh::Node& node, const FloatRange& p, Float8& bounds) {
  Float8 sum = {};
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 below = node.min[axis] - p.high[axis];
    const Float8 above = p.low[axis] - node.max[axis];
    const Float8 farther = below > above ? below : above;
    const Float8 outside = farther > 0.0F ? farther : Float8{};
    sum += outside * outside;
  }
  bounds = sum * (1.0F - 0x1p-20F);
}

/// A triangle of a block; none if the block is null.
struct Spot {
  const TrianglePacket* block = nullptr;
  int lane = 0;
};

/// The triangle with the smallest squared distance below `best2`.
SPRUNG_KERNEL Spot find_nearest(const MeshBvh& tree, const Vector3& p, double best2) {
  const FloatRange range = float_range(p);
  float bound = bound_of(best2);
  Spot best;
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.bound > bound) continue;
    if (entry.child >= 0) {
      const MeshBvh::Node& node = tree.node(entry.child);
      Float8 bounds;
      bound_children(node, range, bounds);
      stack.push_within(bounds, node.child, bound);
      continue;
    }
    const TrianglePacket& block = tree.block(~entry.child);
    Double4 squared;
    squared_distances(p, block, squared);
    const Mask4 nearer = squared < best2;
    for (unsigned lanes = mask_bits(nearer); lanes != 0;) {
      const int lane = pop_lane(lanes);
      if (!(squared[lane] < best2)) continue;
      best2 = squared[lane];
      best = {&block, lane};
    }
    bound = bound_of(best2);
  }
  return best;
}

/// A path in single precision, and a bound of the rounding errors in the test against boxes [m].
struct FloatPath {
  float middle[3];
  float half[3];       ///< half its extent along each axis, >= 0
  float direction[3];  ///< its largest component is 1 or -1
  float rounding;
  int main_axis;
  float begin;       ///< position along the main axis
  float per_length;  ///< 1 / length along the main axis
};

/// If all coordinates are below M, single precision changes a box, the path and the products of the test below by less than 2^-20
/// M (times the direction, for the products). The bound is twice that.
FloatPath float_path(const Vector3& a, const Vector3& b, double magnitude) {
  FloatPath path;
  const Vector3 step = b - a;
  const double length = step.cwiseAbs().maxCoeff(&path.main_axis);
  for (int axis = 0; axis < 3; ++axis) {
    path.middle[axis] = static_cast<float>(0.5 * (a[axis] + b[axis]));
    path.half[axis] = static_cast<float>(0.5 * std::abs(step[axis]));
    path.direction[axis] = static_cast<float>(step[axis] / length);
  }
  path.rounding = static_cast<float>(0x1p-19 * std::max({magnitude, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()}));
  path.begin = static_cast<float>(a[path.main_axis]);
  path.per_length = static_cast<float>(1.0 / length);
  return path;
}

/// Pushes the children whose box the path may cross before the fraction `bound`, the nearest last. Boxes are excluded by
/// separating axes (Gottschalk et al. 1996).
SPRUNG_KERNEL void push_children(const MeshBvh::Node& node, const FloatPath& path, float bound, TraversalStack& stack) {
  const Float8 never = Float8{} + std::numeric_limits<float>::infinity();
  const bool forward = path.direction[path.main_axis] > 0.0F;
  const Float8 ahead = forward ? node.min[path.main_axis] - path.begin : path.begin - node.max[path.main_axis];
  Float8 fraction = (ahead - path.rounding) * path.per_length;
  fraction = fraction > 0.0F ? fraction : Float8{};

  Float8 offset[3];
  Float8 extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = path.middle[axis] - 0.5F * (node.min[axis] + node.max[axis]);
    extent[axis] = 0.5F * (node.max[axis] - node.min[axis]) + path.rounding;
    const Float8 distance = offset[axis] < 0.0F ? -offset[axis] : offset[axis];
    fraction = distance <= extent[axis] + path.half[axis] ? fraction : never;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const Float8 across = offset[u] * path.direction[v] - offset[v] * path.direction[u];
    const Float8 distance = across < 0.0F ? -across : across;
    const Float8 reach = extent[u] * std::abs(path.direction[v]) + extent[v] * std::abs(path.direction[u]);
    fraction = distance <= reach ? fraction : never;
  }
  stack.push_within(fraction, node.child, bound);
}

bool changes_side(double begin, double end, CrossingSides sides) {
  if (sides == CrossingSides::front) return (begin >= 0.0 && end < 0.0) || (begin > 0.0 && end == 0.0);
  return (begin > 0.0 && end <= 0.0) || (begin < 0.0 && end >= 0.0);
}

using Vector2 = Eigen::Vector2d;
using TriangleCorners = std::array<Vector3, 3>;

template <class Visit>
void visit_box(const MeshBvh& tree, const Box3& box, const Visit& visit) {
  visit_blocks(tree, box, [&](std::int32_t number) {
    const TrianglePacket& block = tree.block(number);
    for (unsigned lanes = triangles_in_box(block, box); lanes != 0;) {
      const int lane = pop_lane(lanes);
      visit(block.triangle[lane], block.corners(lane));
    }
  });
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

SPRUNG_KERNEL void push_intersecting(const MeshBvh::Node& node, const FloatBox& box, TraversalStack& stack) {
  Float8 apart = {};
  for (int axis = 0; axis < 3; ++axis) {
    const auto outside = (node.min[axis] > box.max[axis]) | (node.max[axis] < box.min[axis]);
    apart = outside ? Float8{} + 1.0F : apart;
  }
  stack.push_within(apart, node.child, 0.0F);
}

std::optional<MeshBvh::Nearest> MeshBvh::nearest(const Vector3& p, double radius) const {
  if (!(radius > 0.0)) return std::nullopt;
  const auto [block, lane] = find_nearest(*this, p, radius * radius);
  if (block == nullptr) return std::nullopt;
  const auto corners = block->corners(lane);
  return Nearest{block->triangle[lane], closest_point_on_triangle(p, corners[0], corners[1], corners[2]), corners};
}

std::optional<MeshBvh::Hit> MeshBvh::first_hit(const Vector3& a, const Vector3& b, CrossingSides sides) const {
  if (a == b) return std::nullopt;
  const FloatPath path = float_path(a, b, magnitude_);
  const Box3 box(a.cwiseMin(b), a.cwiseMax(b));
  std::optional<Hit> best;
  float bound = 1.0F;
  TraversalStack stack(stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const TraversalEntry entry = stack.pop();
    if (entry.bound > bound) continue;
    if (entry.child < 0) {
      const TrianglePacket& block = this->block(~entry.child);
      for (unsigned lanes = triangles_in_box(block, box); lanes != 0;) {
        const int lane = pop_lane(lanes);
        const auto [u, v, w] = block.corners(lane);
        const auto fraction = crossing_fraction(a, b, u, v, w, sides);
        if (!fraction || (best && std::tie(*fraction, block.triangle[lane]) >= std::tie(best->fraction, best->triangle))) continue;
        best = Hit{block.triangle[lane], *fraction};
        bound = std::nextafter(static_cast<float>(*fraction), 2.0F);
      }
      continue;
    }
    push_children(node(entry.child), path, bound, stack);
  }
  return best;
}

std::optional<double> crossing_fraction(const Vector3& a, const Vector3& b, const Vector3& u, const Vector3& v, const Vector3& w,
                                        CrossingSides sides) {
  const double begin = side_of_plane(u, v, w, a);
  const double end = side_of_plane(u, v, w, b);
  if (!changes_side(begin, end, sides)) return std::nullopt;
  const double uv = side_of_plane(a, b, u, v);
  const double vw = side_of_plane(a, b, v, w);
  if ((uv > 0.0 && vw < 0.0) || (uv < 0.0 && vw > 0.0)) return std::nullopt;
  const double wu = side_of_plane(a, b, w, u);
  const bool around = (uv >= 0.0 && vw >= 0.0 && wu >= 0.0) || (uv <= 0.0 && vw <= 0.0 && wu <= 0.0);
  if (!around) return std::nullopt;
  return begin / (begin - end);
}

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
