#include "collision/safe_regions/safe_region.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sprung {
namespace {

constexpr double kStandOff = 0.3;

// Fraction of the clearance. The clearance is 2^-30 of the coordinates, so this is 2^-42 of them.
constexpr double kTouching = 0x1p-12;

void try_axis(const Vector3& axis, const ElementCorners& element, const TriangleCorners& triangle, TriangleSeparatingPlane& best) {
  const double length = axis.norm();
  if (length == 0.0) return;
  for (const double side : {1.0 / length, -1.0 / length}) {
    const Vector3 normal = side * axis;
    const double gap = lowest_along(normal, element) - highest_along(normal, triangle);
    if (gap > best.gap) best = {normal, gap};
  }
}

/// The closest points may be on two faces, on two edges that are not parallel, or on two edges in one plane.
void try_features(const ElementCorners& element, const TriangleCorners& triangle, const Vector3& line,
                  TriangleSeparatingPlane& best) {
  const auto edges_of = [](const std::array<Vector3, 3>& x) {
    return std::array<Vector3, 3>{x[1] - x[0], x[2] - x[1], x[0] - x[2]};
  };
  const auto edges = edges_of(triangle);
  const auto own_edges = edges_of(element.x);
  const std::span<const Vector3> own(own_edges.data(), element.count == 3 ? 3 : static_cast<std::size_t>(element.count - 1));
  const Vector3 face = edges[0].cross(edges[1]);
  const auto try_side = [&](const Vector3& normal, std::span<const Vector3> border) {
    try_axis(normal, element, triangle, best);
    for (const Vector3& edge : border) {
      try_axis(edge.cross(normal), element, triangle, best);
      try_axis(edge.cross(line.cross(edge)), element, triangle, best);
    }
  };
  try_side(face, edges);
  if (element.count == 3) try_side(own[0].cross(own[1]), own);
  for (const Vector3& a : own) {
    for (const Vector3& b : edges) {
      const Vector3 across = a.cross(b);
      try_axis(across, element, triangle, best);
      try_axis(a.cross(across), element, triangle, best);
      try_axis(b.cross(across), element, triangle, best);
    }
  }
}

}  // namespace

Box3 shrunk(const Box3& box, double margin) { return {box.min().array() + margin, box.max().array() - margin}; }

Box3 box_around(const ElementCorners& element, double reach) {
  Box3 box;
  for (int i = 0; i < element.count; ++i) box.extend(element.x[static_cast<std::size_t>(i)]);
  return {box.min() - Vector3::Constant(reach), box.max() + Vector3::Constant(reach)};
}

Box3 requested_box(const ElementCorners& element, const SafeRegionRequest& request) {
  const Box3 box = box_around(element, 0.0).merged(request.path);
  return {box.min() - Vector3::Constant(request.reach), box.max() + Vector3::Constant(request.reach)};
}

double stand_off(double gap, const SafeRegionRequest& request) {
  return std::min(gap, std::max(request.clearance, std::min(kStandOff * gap, 0.5 * request.gap)));
}

bool is_touching(double gap, const SafeRegionRequest& request) { return !(gap > kTouching * request.clearance); }

double lowest_along(const Vector3& normal, const ElementCorners& element) {
  double lowest = normal.dot(element.x[0]);
  for (int i = 1; i < element.count; ++i) lowest = std::min(lowest, normal.dot(element.x[static_cast<std::size_t>(i)]));
  return lowest;
}

double highest_along(const Vector3& normal, const TriangleCorners& triangle) {
  return std::max({normal.dot(triangle[0]), normal.dot(triangle[1]), normal.dot(triangle[2])});
}

TriangleSeparatingPlane separation(const ElementCorners& element, const TriangleCorners& triangle, const ClosestPair& pair,
                                   double slack) {
  TriangleSeparatingPlane best;
  const double distance = std::sqrt(pair.squared_distance);
  if (distance > 0.0) {
    best.normal = (pair.on_simplex - pair.on_triangle) / distance;
    best.gap = lowest_along(best.normal, element) - highest_along(best.normal, triangle);
    if (best.gap >= (1.0 - 2.0 * slack) * distance) return best;
  }
  try_features(element, triangle, pair.on_simplex - pair.on_triangle, best);
  return best;
}

}  // namespace sprung
