#include "geometry/queries/simplex_crossing.h"

#include "geometry/queries/side_of_plane.h"

namespace sprung {

namespace {

using Vector2 = Eigen::Vector2d;

bool one_side(double s, double t, double r) { return (s >= 0.0 && t >= 0.0 && r >= 0.0) || (s <= 0.0 && t <= 0.0 && r <= 0.0); }

bool differ(double s, double t) { return (s >= 0.0 && t <= 0.0) || (s <= 0.0 && t >= 0.0); }

/// Whether the triangle, which has an area, contains p; in the plane.
bool contains(const std::array<Vector2, 3>& triangle, const Vector2& p) {
  return one_side(side_of_line(triangle[0], triangle[1], p), side_of_line(triangle[1], triangle[2], p),
                  side_of_line(triangle[2], triangle[0], p));
}

/// False for collinear segments: if they overlap, `contains` or another edge of the triangle finds it.
bool cross(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
  const double side_c = side_of_line(a, b, c);
  const double side_d = side_of_line(a, b, d);
  if (side_c == 0.0 && side_d == 0.0) return false;
  return differ(side_c, side_d) && differ(side_of_line(c, d, a), side_of_line(c, d, b));
}

/// All points lie in one plane: projects along an axis in which the triangle has an area.
bool intersects_in_plane(const Vector3& a, const Vector3& b, const std::array<Vector3, 3>& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto seen = [axis](const Vector3& p) { return Vector2(p[(axis + 1) % 3], p[(axis + 2) % 3]); };
    const std::array<Vector2, 3> corners{seen(triangle[0]), seen(triangle[1]), seen(triangle[2])};
    if (side_of_line(corners[0], corners[1], corners[2]) == 0.0) continue;
    if (contains(corners, seen(a)) || contains(corners, seen(b))) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cross(seen(a), seen(b), corners[k], corners[(k + 1) % 3])) return true;
    }
    return false;
  }
  return false;
}

/// Whether the boxes round two segments overlap: if these lie on one line, whether they do.
bool boxes_overlap(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() && (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
}

}  // namespace

bool intersects(const Vector3& a, const Vector3& b, const std::array<Vector3, 3>& triangle) {
  const auto& [u, v, w] = triangle;
  const double side_a = side_of_plane(u, v, w, a);
  const double side_b = side_of_plane(u, v, w, b);
  if (!differ(side_a, side_b)) return false;
  if (side_a == 0.0 && side_b == 0.0) return intersects_in_plane(a, b, triangle);
  return one_side(side_of_plane(a, b, u, v), side_of_plane(a, b, v, w), side_of_plane(a, b, w, u));
}

bool intersects(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  if (!boxes_overlap(a, b, c, d) || side_of_plane(a, b, c, d) != 0.0) return false;
  // All points lie in one plane. An axis along which they do not all fall on one line shows whether the segments cross.
  for (int axis = 0; axis < 3; ++axis) {
    const auto seen = [axis](const Vector3& p) { return Vector2(p[(axis + 1) % 3], p[(axis + 2) % 3]); };
    const double side_a = side_of_line(seen(c), seen(d), seen(a));
    const double side_b = side_of_line(seen(c), seen(d), seen(b));
    const double side_c = side_of_line(seen(a), seen(b), seen(c));
    const double side_d = side_of_line(seen(a), seen(b), seen(d));
    if (side_a == 0.0 && side_b == 0.0 && side_c == 0.0 && side_d == 0.0) continue;
    return differ(side_a, side_b) && differ(side_c, side_d);
  }
  return true;
}

bool intersects(const Simplex& simplex, const std::array<Vector3, 3>& triangle) {
  const auto& x = simplex.x;
  if (simplex.count == 1) return intersects(x[0], x[0], triangle);
  if (simplex.count == 2) return intersects(x[0], x[1], triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    if (intersects(x[k], x[(k + 1) % 3], triangle) || intersects(triangle[k], triangle[(k + 1) % 3], x)) return true;
  }
  return false;
}

}  // namespace sprung
