// Separating plane of an element and a triangle.
#pragma once

#include "collision/safe_regions/safe_region.h"

#include <array>
#include <limits>

namespace sprung {

using TriangleCorners = std::array<Vector3, 3>;

/// The direction from the triangle to the element with the largest separation.
struct TriangleSeparatingPlane {
  Vector3 normal = Vector3::Zero();                       ///< unit length
  double gap = -std::numeric_limits<double>::infinity();  ///< lowest height of the element minus the triangle's highest [m]
};

[[nodiscard]] double lowest_along(const Vector3& normal, const ElementCorners& element);
[[nodiscard]] double highest_along(const Vector3& normal, const TriangleCorners& triangle);

/// Finds a separating plane. The direction between the closest points separates by their whole distance. If that distance is
/// within rounding of the coordinates, this direction is inaccurate. Then the face normals and the cross products of edges are
/// tried too. `pair` and `slack` come from closest_pair. If the gap is not positive, element and triangle cross or touch.
[[nodiscard]] TriangleSeparatingPlane separation(const ElementCorners& element, const TriangleCorners& triangle,
                                                 const ClosestPair& pair, double slack);

}  // namespace sprung
