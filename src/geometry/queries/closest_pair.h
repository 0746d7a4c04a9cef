// Closest points of two simplices: what two surfaces are to each other.
#pragma once

#include "geometry/queries/closest_point.h"

#include <array>
#include <cstdint>

namespace sprung {

/// The point of segment (a0, a1) at `s` and that of (b0, b1) at `t`, both in [0, 1], that are nearest to each other.
struct SegmentPair {
  double s = 0.0;
  double t = 0.0;
  double squared_distance = 0.0;  ///< [m^2]
};

/// Ericson 2005, section 5.1.9. Segments may be parallel or have no length.
[[nodiscard]] SegmentPair closest_points_of_segments(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1);

/// Weights of the corners whose sum is the point that `closest` names on triangle (a, b, c); they are not negative, their sum is 1.
[[nodiscard]] Vector3 barycentric(const ClosestPoint& closest, const Vector3& a, const Vector3& b, const Vector3& c);

/// A point, a segment or a triangle: the convex hull of its corners [m].
struct Simplex {
  std::array<Vector3, 3> x{};
  int count = 0;  ///< of the corners used, 1 to 3
};

/// What a nearest pair of a simplex and a triangle lies on.
enum class PairFeatures : std::uint8_t {
  unknown,
  corner_face,  ///< a corner of the simplex, and the triangle
  face_corner,  ///< the simplex, and a corner of the triangle
  edges         ///< an edge of each
};

/// Those features, by their places: an edge leads from the corner of its number to the next one.
struct PairPlace {
  PairFeatures features = PairFeatures::unknown;
  std::uint8_t of_simplex = 0;   ///< a corner or an edge; 0 for its face
  std::uint8_t of_triangle = 0;  ///< a corner or an edge; 0 for its face
};

/// The points of a simplex and of a triangle that are nearest to each other.
struct ClosestPair {
  Vector3 on_simplex = Vector3::Zero();
  Vector3 on_triangle = Vector3::Zero();
  Vector3 weights = Vector3::Zero();  ///< of the simplex's corners; their sum is 1
  double squared_distance = 0.0;      ///< [m^2]
  PairPlace place{};
};

/// The nearest pair among corner and face, face and corner, edge and edge: right for simplices that do not cross. Where they do,
/// the distance has no meaning, and no plane separates them along the line between the points. Edges are not looked at once corners
/// and faces give a pair whose plane separates by all of its distance but rounding; with `slack` > 0, and where the pair is not
/// nearer than `exact` [m], by (1 - slack) of it: then the distance is at most 1 / (1 - slack) of the true one.
///
/// What lay at `last` before is looked for there first: a plane that separates by as much proves it to be as near still. That is a
/// place on a simplex of as many corners, and on any triangle.
[[nodiscard]] ClosestPair closest_pair(const Simplex& simplex, const std::array<Vector3, 3>& triangle, double slack = 0.0,
                                       double exact = 0.0, const PairPlace& last = {});

}  // namespace sprung
