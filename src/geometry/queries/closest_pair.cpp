#include "geometry/queries/closest_pair.h"

#include "base/machine/kernel.h"
#include "geometry/queries/closest_point_simd.h"
#include "geometry/queries/segment_pair_simd.h"

#include <algorithm>
#include <limits>

namespace sprung {

namespace {

// A plane that separates by the distance, up to this fraction, proves that the distance is the least one.
constexpr double kRounding = 1e-12;

using Corners = std::array<Vector3, 3>;

/// The corners of the simplex against the triangle, one lane per corner; then the corners of the triangle against the simplex.
struct CornerPairs {
  std::array<ClosestPointLanes, 2> closest;
};

/// For each edge of the simplex, one lane per edge of the triangle.
struct EdgePairs {
  std::array<SegmentPairLanes, 3> closest;
};

/// Lanes beyond `count` repeat the last point.
[[gnu::always_inline]] inline void measure(const Corners& points, int count, const Corners& triangle, ClosestPointLanes& closest) {
  Vector3x4 p;
  for (int lane = 0; lane < kSimdWidth; ++lane) set_lane(lane, points[static_cast<std::size_t>(std::min(lane, count - 1))], p);
  TriangleLanes triangles;
  set_all_lanes(triangle[0], triangles.a);
  set_all_lanes(triangle[1], triangles.b);
  set_all_lanes(triangle[2], triangles.c);
  unsigned needles = closest_points(p, triangles, closest);
  while (needles != 0) {
    const int lane = pop_lane(needles);
    const Vector3& point = points[static_cast<std::size_t>(std::min(lane, count - 1))];
    const ClosestPoint found = closest_point_on_triangle(point, triangle[0], triangle[1], triangle[2]);
    const Vector3 weights = barycentric(found, triangle[0], triangle[1], triangle[2]);
    closest.squared_distance[lane] = found.squared_distance;
    set_lane(lane, found.point, closest.point);
    closest.of_a[lane] = weights[0];
    closest.of_b[lane] = weights[1];
    closest.of_c[lane] = weights[2];
  }
}

SPRUNG_KERNEL void measure_corners(const Simplex& simplex, const Corners& triangle, CornerPairs& pairs) {
  measure(simplex.x, simplex.count, triangle, pairs.closest[0]);
  if (simplex.count == 3) measure(triangle, 3, simplex.x, pairs.closest[1]);
}

/// The fourth lane repeats the first edge of the triangle.
[[gnu::always_inline]] inline void measure(const Vector3& from, const Vector3& to, const Corners& triangle,
                                           SegmentPairLanes& closest) {
  SegmentLanes segment;
  set_all_lanes(from, segment.from);
  set_all_lanes(to, segment.to);
  SegmentLanes edges;
  for (int lane = 0; lane < kSimdWidth; ++lane) {
    set_lane(lane, triangle[static_cast<std::size_t>(lane % 3)], edges.from);
    set_lane(lane, triangle[static_cast<std::size_t>((lane + 1) % 3)], edges.to);
  }
  unsigned points = closest_points(segment, edges, closest);
  while (points != 0) {
    const int lane = pop_lane(points);
    const auto k = static_cast<std::size_t>(lane % 3);
    const SegmentPair found = closest_points_of_segments(from, to, triangle[k], triangle[(k + 1) % 3]);
    closest.squared_distance[lane] = found.squared_distance;
    closest.s[lane] = found.s;
    closest.t[lane] = found.t;
  }
}

SPRUNG_KERNEL void measure_edges(const Simplex& simplex, const Corners& triangle, EdgePairs& pairs) {
  measure(simplex.x[0], simplex.x[1], triangle, pairs.closest[0]);
  if (simplex.count < 3) return;
  measure(simplex.x[1], simplex.x[2], triangle, pairs.closest[1]);
  measure(simplex.x[2], simplex.x[0], triangle, pairs.closest[2]);
}

struct Slot {
  std::size_t group = 0;
  int lane = 0;
};

/// The slot of the least distance in the first three lanes of each group.
template <class Groups>
Slot least(const Groups& groups, std::size_t count) {
  Slot best;
  for (std::size_t group = 0; group < count; ++group) {
    for (int lane = 0; lane < 3; ++lane) {
      const bool less = groups[group].squared_distance[lane] < groups[best.group].squared_distance[best.lane];
      best = less ? Slot{group, lane} : best;
    }
  }
  return best;
}

/// Keeps the nearest of the pairs that it has computed.
class NearestPair {
 public:
  NearestPair(const Simplex& simplex, const Corners& triangle) : simplex_(simplex), triangle_(triangle) {}

  /// Takes the pair on these features as the nearest one.
  void consider(const FeaturePair& features) {
    const std::size_t i = features.of_simplex;
    const std::size_t k = features.of_triangle;
    if (features.kind == FeaturePairKind::corner_face) {
      keep_corner(features, closest_point_on_triangle(simplex_.x[i], triangle_[0], triangle_[1], triangle_[2]).point);
    } else if (features.kind == FeaturePairKind::face_corner) {
      const auto& [a, b, c] = simplex_.x;
      const ClosestPoint closest = closest_point_on_triangle(triangle_[k], a, b, c);
      keep_face(features, closest.point, barycentric(closest, a, b, c));
    } else {
      const SegmentPair pair = closest_points_of_segments(simplex_.x[i], simplex_.x[next(i)], triangle_[k], triangle_[(k + 1) % 3]);
      keep_edges(features, pair.s, pair.t);
    }
    best_.squared_distance = (best_.on_simplex - best_.on_triangle).squaredNorm();
  }

  void corners_against_faces() {
    CornerPairs pairs;
    measure_corners(simplex_, triangle_, pairs);
    const auto [group, lane] = least(pairs.closest, simplex_.count == 3 ? 2 : 1);
    const ClosestPointLanes& closest = pairs.closest[group];
    const Vector3 point(closest.point.x[lane], closest.point.y[lane], closest.point.z[lane]);
    best_.squared_distance = closest.squared_distance[lane];
    if (group == 0) {
      keep_corner({FeaturePairKind::corner_face, number(std::min(lane, simplex_.count - 1)), 0}, point);
    } else {
      keep_face({FeaturePairKind::face_corner, 0, number(lane)}, point,
                {closest.of_a[lane], closest.of_b[lane], closest.of_c[lane]});
    }
  }

  void edges_against_edges() {
    EdgePairs pairs;
    measure_edges(simplex_, triangle_, pairs);
    const auto [i, lane] = least(pairs.closest, simplex_.count == 3 ? 3 : 1);
    const SegmentPairLanes& closest = pairs.closest[i];
    if (closest.squared_distance[lane] >= best_.squared_distance) return;
    keep_edges({FeaturePairKind::edges, static_cast<std::uint8_t>(i), number(lane)}, closest.s[lane], closest.t[lane]);
    best_.squared_distance = closest.squared_distance[lane];
  }

  /// Whether the plane across the best pair separates by this fraction of its distance.
  [[nodiscard]] bool separates(double fraction) const {
    const Vector3 along = best_.on_simplex - best_.on_triangle;
    double lowest = along.dot(simplex_.x[0]);
    for (int i = 1; i < simplex_.count; ++i) lowest = std::min(lowest, along.dot(simplex_.x[i]));
    const double highest = std::max({along.dot(triangle_[0]), along.dot(triangle_[1]), along.dot(triangle_[2])});
    return lowest - highest >= fraction * best_.squared_distance;
  }

  [[nodiscard]] const ClosestPair& best() const { return best_; }

 private:
  static std::uint8_t number(int lane) { return static_cast<std::uint8_t>(lane); }
  [[nodiscard]] std::size_t next(std::size_t corner) const { return (corner + 1) % static_cast<std::size_t>(simplex_.count); }

  void keep_corner(const FeaturePair& features, const Vector3& on_triangle) {
    best_.features = features;
    best_.on_simplex = simplex_.x[features.of_simplex];
    best_.on_triangle = on_triangle;
    best_.weights = Vector3::Unit(features.of_simplex);
  }

  void keep_face(const FeaturePair& features, const Vector3& on_simplex, const Vector3& weights) {
    best_.features = features;
    best_.on_simplex = on_simplex;
    best_.on_triangle = triangle_[features.of_triangle];
    best_.weights = weights;
  }

  void keep_edges(const FeaturePair& features, double s, double t) {
    const std::size_t i = features.of_simplex;
    const std::size_t k = features.of_triangle;
    best_.features = features;
    best_.on_simplex = simplex_.x[i] + s * (simplex_.x[next(i)] - simplex_.x[i]);
    best_.on_triangle = triangle_[k] + t * (triangle_[(k + 1) % 3] - triangle_[k]);
    best_.weights.setZero();
    best_.weights[static_cast<Index>(i)] = 1.0 - s;
    best_.weights[static_cast<Index>(next(i))] = s;
  }

  const Simplex& simplex_;
  const Corners& triangle_;
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
    // Nearly parallel segments have a closest pair at one of their ends. Below this bound, rounding of sine2 could put the pair
    // anywhere.
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

ClosestPair closest_pair(const Simplex& simplex, const std::array<Vector3, 3>& triangle, double slack, double exact,
                         const FeaturePair& last) {
  NearestPair nearest(simplex, triangle);
  const auto is_proved = [&] {
    const double allowed = nearest.best().squared_distance < exact * exact ? kRounding : std::max(slack, kRounding);
    return nearest.separates(1.0 - allowed);
  };
  if (last.kind != FeaturePairKind::unknown) {
    nearest.consider(last);
    if (is_proved()) return nearest.best();
  }
  nearest.corners_against_faces();
  if (simplex.count == 1 || is_proved()) return nearest.best();
  nearest.edges_against_edges();
  return nearest.best();
}

}  // namespace sprung
