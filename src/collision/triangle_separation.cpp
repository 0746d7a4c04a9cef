#include "collision/triangle_separation.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

void try_axis(const Vector3& axis, const ElementCorners& element, const TriangleCorners& triangle, TriangleSeparation& best) {
  const double length = axis.norm();
  if (length == 0.0) return;
  for (const double side : {1.0 / length, -1.0 / length}) {
    const Vector3 normal = side * axis;
    const double gap = lowest_along(normal, element) - highest_along(normal, triangle);
    if (gap > best.gap) best = {normal, gap};
  }
}

void try_features(const ElementCorners& element, const TriangleCorners& triangle, TriangleSeparation& best) {
  const std::array<Vector3, 3> edges{triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
  const Vector3 face = edges[0].cross(edges[1]);
  try_axis(face, element, triangle, best);
  for (const Vector3& edge : edges) try_axis(edge.cross(face), element, triangle, best);
  const int own_edges = element.count == 3 ? 3 : element.count - 1;
  for (int i = 0; i < own_edges; ++i) {
    const Vector3 own = element.x[static_cast<std::size_t>((i + 1) % element.count)] - element.x[static_cast<std::size_t>(i)];
    for (const Vector3& edge : edges) try_axis(own.cross(edge), element, triangle, best);
  }
  if (element.count == 3) try_axis((element.x[1] - element.x[0]).cross(element.x[2] - element.x[0]), element, triangle, best);
}

}  // namespace

double lowest_along(const Vector3& normal, const ElementCorners& element) {
  double lowest = normal.dot(element.x[0]);
  for (int i = 1; i < element.count; ++i) lowest = std::min(lowest, normal.dot(element.x[static_cast<std::size_t>(i)]));
  return lowest;
}

double highest_along(const Vector3& normal, const TriangleCorners& triangle) {
  return std::max({normal.dot(triangle[0]), normal.dot(triangle[1]), normal.dot(triangle[2])});
}

TriangleSeparation separation(const ElementCorners& element, const TriangleCorners& triangle, const ClosestPair& pair,
                              double slack) {
  TriangleSeparation best;
  const double distance = std::sqrt(pair.squared_distance);
  if (distance > 0.0) {
    best.normal = (pair.on_simplex - pair.on_triangle) / distance;
    best.gap = lowest_along(best.normal, element) - highest_along(best.normal, triangle);
    if (best.gap >= (1.0 - 2.0 * slack) * distance) return best;
  }
  try_features(element, triangle, best);
  return best;
}

}  // namespace sprung
