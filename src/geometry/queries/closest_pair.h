// Closest points of two simplices.
#pragma once

#include "base/files/binary_archive.h"
#include "geometry/queries/closest_point.h"

#include <array>
#include <cstdint>

namespace sprung {

/// The closest points of two segments: at a0 + s (a1 - a0) and b0 + t (b1 - b0), s and t in [0, 1].
struct SegmentPair {
  double s = 0.0;
  double t = 0.0;
  double squared_distance = 0.0;  ///< [m^2]
};

/// Ericson 2005, section 5.1.9. Segments may be parallel or have no length.
[[nodiscard]] SegmentPair closest_points_of_segments(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1);

/// Barycentric weights of the point `closest` of triangle (a, b, c). They are not negative, and their sum is 1.
[[nodiscard]] Vector3 barycentric(const ClosestPoint& closest, const Vector3& a, const Vector3& b, const Vector3& c);

/// A point, a segment or a triangle: the convex hull of its corners [m].
struct Simplex {
  std::array<Vector3, 3> x{};
  int count = 0;  ///< number of corners, 1 to 3
};

/// The kind of features on which the closest points of a simplex and a triangle lie.
enum class FeaturePairKind : std::uint8_t {
  unknown,
  corner_face,  ///< a corner of the simplex and the face of the triangle
  face_corner,  ///< the face of the simplex and a corner of the triangle
  edges         ///< one edge of each
};

/// The features on which a closest pair lies. Edge k leads from corner k to the next corner.
struct FeaturePair {
  FeaturePairKind kind = FeaturePairKind::unknown;
  std::uint8_t of_simplex = 0;   ///< number of the corner or edge; 0 for the face
  std::uint8_t of_triangle = 0;  ///< number of the corner or edge; 0 for the face
};

template <Same<FeaturePair> S, class Visit>
void visit_members(S& f, const Visit& visit) {
  visit(f.kind, f.of_simplex, f.of_triangle);
}

/// The closest points of a simplex and a triangle.
struct ClosestPair {
  Vector3 on_simplex = Vector3::Zero();
  Vector3 on_triangle = Vector3::Zero();
  Vector3 weights = Vector3::Zero();  ///< of the corners of the simplex; their sum is 1
  double squared_distance = 0.0;      ///< [m^2]
  FeaturePair features{};
};

/// The closest pair among corner-face, face-corner and edge-edge pairs. Requires simplices that do not intersect; otherwise the
/// distance has no meaning, and the plane across the pair does not separate them. Edges are skipped if the plane across the best
/// corner-face pair separates the simplices by the pair's distance, up to rounding. If `slack` > 0 and the pair is not nearer than
/// `exact` [m], a separation of (1 - slack) times the distance suffices; the result is then at most 1 / (1 - slack) of the true
/// distance.
///
/// Tries the features `last` of an earlier query first and returns their pair if its plane separates by as much. `last` may belong
/// to another triangle, but its simplex must have as many corners.
[[nodiscard]] ClosestPair closest_pair(const Simplex& simplex, const std::array<Vector3, 3>& triangle, double slack = 0.0,
                                       double exact = 0.0, const FeaturePair& last = {});

}  // namespace sprung
