#include "geometry/closest_pair.h"

#include <algorithm>
#include <limits>

namespace sprung {

namespace {

// A plane that separates by all but this part of a distance proves it to be the least.
constexpr double kRounding = 1e-12;

/// Keeps the nearest pair that it is shown.
class NearestPair {
 public:
  NearestPair(const Simplex& simplex, const std::array<Vector3, 3>& triangle) : simplex_(simplex), triangle_(triangle) {}

  void corners_against_face() {
    for (int i = 0; i < simplex_.count; ++i) {
      const ClosestPoint found = closest_point_on_triangle(simplex_.x[i], triangle_[0], triangle_[1], triangle_[2]);
      if (found.squared_distance >= best_.squared_distance) continue;
      best_ = {simplex_.x[i], found.point, Vector3::Unit(i), found.squared_distance};
    }
  }

  void face_against_corners() {
    for (const Vector3& corner : triangle_) {
      const ClosestPoint found = closest_point_on_triangle(corner, simplex_.x[0], simplex_.x[1], simplex_.x[2]);
      if (found.squared_distance >= best_.squared_distance) continue;
      best_ = {found.point, corner, barycentric(found, simplex_.x[0], simplex_.x[1], simplex_.x[2]), found.squared_distance};
    }
  }

  void edges_against_edges() {
    const int edges = simplex_.count == 3 ? 3 : simplex_.count - 1;
    for (int i = 0; i < edges; ++i) {
      const int next = (i + 1) % simplex_.count;
      for (std::size_t j = 0; j < 3; ++j) {
        const Vector3& b0 = triangle_[j];
        const Vector3& b1 = triangle_[(j + 1) % 3];
        const SegmentPair found = closest_points_of_segments(simplex_.x[i], simplex_.x[next], b0, b1);
        if (found.squared_distance >= best_.squared_distance) continue;
        best_.on_simplex = simplex_.x[i] + found.s * (simplex_.x[next] - simplex_.x[i]);
        best_.on_triangle = b0 + found.t * (b1 - b0);
        best_.weights = (1.0 - found.s) * Vector3::Unit(i) + found.s * Vector3::Unit(next);
        best_.squared_distance = found.squared_distance;
      }
    }
  }

  /// Whether the plane across the best pair separates by this part of its distance.
  [[nodiscard]] bool separates(double part) const {
    const Vector3 along = best_.on_simplex - best_.on_triangle;
    double lowest = along.dot(simplex_.x[0]);
    for (int i = 1; i < simplex_.count; ++i) lowest = std::min(lowest, along.dot(simplex_.x[i]));
    const double highest = std::max({along.dot(triangle_[0]), along.dot(triangle_[1]), along.dot(triangle_[2])});
    return lowest - highest >= part * best_.squared_distance;
  }

  [[nodiscard]] const ClosestPair& best() const { return best_; }

 private:
  const Simplex& simplex_;
  const std::array<Vector3, 3>& triangle_;
  ClosestPair best_{.squared_distance = std::numeric_limits<double>::infinity()};
};

}  // namespace

SegmentPair closest_points_of_segments(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) {
  const Vector3 along_a = a1 - a0;
  const Vector3 along_b = b1 - b0;
  const Vector3 between = a0 - b0;
  const double aa = along_a.squaredNorm();
  const double bb = along_b.squaredNorm();
  const double from_a = along_a.dot(between);
  const double from_b = along_b.dot(between);
  SegmentPair pair;
  if (aa == 0.0 || bb == 0.0) {
    if (aa > 0.0) pair.s = std::clamp(-from_a / aa, 0.0, 1.0);
    if (bb > 0.0) pair.t = std::clamp(from_b / bb, 0.0, 1.0);
  } else {
    const double ab = along_a.dot(along_b);
    const double sine2 = aa * bb - ab * ab;
    // Nearly parallel segments have a pair at one of their ends; below this, rounding of sine2 could put it anywhere.
    if (sine2 > 1e-14 * aa * bb) pair.s = std::clamp((ab * from_b - from_a * bb) / sine2, 0.0, 1.0);
    pair.t = (ab * pair.s + from_b) / bb;
    if (pair.t < 0.0 || pair.t > 1.0) {
      pair.t = std::clamp(pair.t, 0.0, 1.0);
      pair.s = std::clamp((pair.t * ab - from_a) / aa, 0.0, 1.0);
    }
  }
  pair.squared_distance = (between + pair.s * along_a - pair.t * along_b).squaredNorm();
  return pair;
}

Vector3 barycentric(const ClosestPoint& closest, const Vector3& a, const Vector3& b, const Vector3& c) {
  const std::array<const Vector3*, 3> corners{&a, &b, &c};
  const int feature = static_cast<int>(closest.feature);
  if (feature < 3) return Vector3::Unit(feature);
  if (closest.feature != TriangleFeature::face) {
    const int from = feature - 3;
    const int to = (from + 1) % 3;
    const Vector3 along = *corners[to] - *corners[from];
    const double t = std::clamp(along.dot(closest.point - *corners[from]) / along.squaredNorm(), 0.0, 1.0);
    return (1.0 - t) * Vector3::Unit(from) + t * Vector3::Unit(to);
  }
  const Vector3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const double v = std::clamp(normal.dot((closest.point - a).cross(c - a)) / area2, 0.0, 1.0);
  const double w = std::clamp(normal.dot((b - a).cross(closest.point - a)) / area2, 0.0, 1.0 - v);
  return {1.0 - v - w, v, w};
}

ClosestPair closest_pair(const Simplex& simplex, const std::array<Vector3, 3>& triangle, double slack, double exact) {
  NearestPair nearest(simplex, triangle);
  nearest.corners_against_face();
  if (simplex.count == 1) return nearest.best();
  if (simplex.count == 3) nearest.face_against_corners();
  const double allowed = nearest.best().squared_distance < exact * exact ? kRounding : std::max(slack, kRounding);
  if (nearest.separates(1.0 - allowed)) return nearest.best();
  nearest.edges_against_edges();
  return nearest.best();
}

}  // namespace sprung
