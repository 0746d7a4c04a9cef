// Closest points on a triangle, with the feature on which they lie.
#pragma once

#include "base/types.h"

namespace sprung {

/// A feature of a triangle: a vertex (0, 1, 2), an edge (from corner 0, 1 or 2 to the next one), or the face.
enum class TriangleFeature : std::uint8_t { vertex0, vertex1, vertex2, edge01, edge12, edge20, face };

struct ClosestPoint {
  Vector3 point;
  double squared_distance = 0.0;  ///< [m^2]
  TriangleFeature feature = TriangleFeature::face;
};

/// The point of triangle (a, b, c) nearest to p (Ericson 2005, section 5.1.5). Degenerate triangles are allowed.
[[nodiscard]] ClosestPoint closest_point_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace sprung
