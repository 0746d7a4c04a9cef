// The plane between an element and a triangle.
#pragma once

#include "collision/safe_regions/safe_region.h"

#include <array>
#include <limits>

namespace sprung {

using TriangleCorners = std::array<Vector3, 3>;

/// The direction, from the triangle to the element, in which they are farthest apart.
struct TriangleSeparatingPlane {
  Vector3 normal = Vector3::Zero();  ///< unit length
  double gap =
      -std::numeric_limits<double>::infinity();  ///< between what lies lowest of the element and highest of the triangle [m]
};

[[nodiscard]] double lowest_along(const Vector3& normal, const ElementCorners& element);
[[nodiscard]] double highest_along(const Vector3& normal, const TriangleCorners& triangle);

/// The line between the nearest points separates by all of their distance. But where that is next to nothing beside the corners'
/// coordinates, rounding turns the line, and it is the faces' normals and the products of edges that still tell the sides apart:
/// those are tried too where `pair` with its `slack` (see closest_pair) does not keep what it promises. A gap that is not positive
/// says that they cross or touch.
[[nodiscard]] TriangleSeparatingPlane separation(const ElementCorners& element, const TriangleCorners& triangle,
                                                 const ClosestPair& pair, double slack);

}  // namespace sprung
