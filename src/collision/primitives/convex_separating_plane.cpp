#include "collision/primitives/primitive_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

/// A point of an edge.
struct EdgeSample {
  double along = 0.0;     ///< from the begin of the edge [m]
  double distance = 0.0;  ///< from the shape [m]
  double slope = 0.0;     ///< of the distance along the edge
};

/// The intersection of the tangents of two samples. The distance is convex, so it is nowhere smaller between them.
EdgeSample crossing_of_tangents(const EdgeSample& low, const EdgeSample& high) {
  const double width = high.along - low.along;
  const double ahead = (high.distance - low.distance - high.slope * width) / (low.slope - high.slope);
  return {low.along + ahead, low.distance + low.slope * ahead, 0.0};
}

/// If the closest point of the shape is the same along the edge, the distance is a hyperbola and this function is linear.
double steepness(double slope) { return slope / std::sqrt(std::max((1.0 - slope) * (1.0 + slope), 1e-30)); }

double zero_of_steepness(const EdgeSample& low, const EdgeSample& high) {
  const double falls = steepness(low.slope);
  return low.along + (high.along - low.along) * falls / (falls - steepness(high.slope));
}

/// A bracket of the minimum of the distance along an edge: it decreases at the begin and increases at the end.
class ConvexLineSearch {
 public:
  ConvexLineSearch(const EdgeSample& low, const EdgeSample& high) : low_(low), high_(high), width_(high.along - low.along) {}

  /// The position of the next sample [m]. Three rules alternate: the minimum for a single closest point, the intersection of the
  /// tangents, and bisection if the first two did not halve the bracket.
  double next() {
    const int rule = steps_++ % 3;
    const double width = high_.along - low_.along;
    const double at = rule == 1 ? crossing_of_tangents(low_, high_).along : zero_of_steepness(low_, high_);
    const bool slow = rule == 2 && width > 0.5 * width_;
    if (rule == 2) width_ = width;
    return slow || !contains(at) ? low_.along + 0.5 * width : at;
  }

  /// Whether the position [m] is inside the bracket.
  [[nodiscard]] bool contains(double along) const { return along > low_.along && along < high_.along; }

  /// Cuts the bracket at a sample inside it.
  void cut(const EdgeSample& at) { (at.slope < 0.0 ? low_ : high_) = at; }

 private:
  EdgeSample low_;
  EdgeSample high_;
  double width_;
  int steps_ = 0;
};

// A separation is good enough if it proves this fraction of the distance.
constexpr double kProvenFraction = 0.998;

// Three steps at least halve the bracket. Two or three steps are usual.
constexpr int kMaxEdgeSteps = 150;

int lowest_corner(const ElementCorners& element, const Vector3& normal) {
  int lowest = 0;
  double low = normal.dot(element.x[0]);
  for (int i = 1; i < element.count; ++i) {
    const double height = normal.dot(element.x[static_cast<std::size_t>(i)]);
    if (height < low) lowest = i;
    low = std::min(low, height);
  }
  return lowest;
}

/// Directions of straight lines in the surface of the shape, at or near `point`. If shape and element nearly touch, the separating
/// direction is perpendicular to two lines, or to a line and an edge. The cross product is then accurate, whereas the difference
/// of two nearly equal points is not. For boxes these directions are complete (Gottschalk, Lin and Manocha 1996).
template <class Shape>
std::vector<Vector3> straight_lines(const Shape& /*shape*/, const Vector3& /*point*/) {
  return {};
}

std::vector<Vector3> straight_lines(const BoxGeometry& /*box*/, const Vector3& /*point*/) {
  return {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
}

/// `slope`: increase of the radius per metre of height.
std::vector<Vector3> lines_of_round_side(const Vector3& point, double slope) {
  const double radius = std::hypot(point.x(), point.z());
  const Vector3 outward = radius > 0.0 ? Vector3(point.x() / radius, 0.0, point.z() / radius) : Vector3::UnitX();
  return {outward, outward.cross(Vector3::UnitY()), Vector3::UnitY() + slope * outward};
}

std::vector<Vector3> straight_lines(const CylinderGeometry& /*cylinder*/, const Vector3& point) {
  return lines_of_round_side(point, 0.0);
}

std::vector<Vector3> straight_lines(const ConeGeometry& cone, const Vector3& point) {
  return lines_of_round_side(point, -cone.radius / cone.height);
}

template <class Shape>
class SeparationSearch {
 public:
  SeparationSearch(const Shape& shape, const ElementCorners& element) : shape_(shape), element_(element) { try_corner(0); }

  [[nodiscard]] const SeparatingPlane& best() const { return best_; }

  void finish() {
    if (element_.count == 3 && !settled()) try_face();
    for (int i = 1; i < element_.count && !settled(); ++i) try_corner(i);
    const int edges = element_.count == 3 ? 3 : element_.count - 1;
    for (int i = 0; i < edges && !settled(); ++i) try_edge(i, (i + 1) % element_.count);
    if (settled()) return;
    const std::vector<Vector3> lines = straight_lines(shape_, best_.point);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      try_both_directions(lines[k].cross(lines[(k + 1) % lines.size()]));
      for (int i = 0; i < edges; ++i) try_both_directions(lines[k].cross(corner((i + 1) % element_.count) - corner(i)));
    }
  }

 private:
  [[nodiscard]] bool settled() const { return best_.gap > 0.0 && best_.gap >= kProvenFraction * best_.distance; }
  [[nodiscard]] const Vector3& corner(int i) const { return element_.x[static_cast<std::size_t>(i)]; }

  void try_direction(const Vector3& normal) {
    const int at = lowest_corner(element_, normal);
    const double low = normal.dot(corner(at));
    const double height = normal.dot(support_point(shape_, normal));
    if (!(low - height > best_.gap)) return;
    best_.normal = normal;
    best_.height = height;
    best_.lowest = low;
    best_.lowest_corner = at;
    best_.gap = low - height;
  }

  void try_pair(const Vector3& point, const Vector3& weights, double distance) {
    if (!(distance < best_.distance)) return;
    best_.point = point;
    best_.weights = weights;
    best_.distance = distance;
  }

  void try_corner(int i) {
    const SurfacePoint surface = surface_point(shape_, corner(i));
    try_direction(surface.normal);
    try_pair(surface.point, Vector3::Unit(i), surface.distance);
    at_corner_[static_cast<std::size_t>(i)] = surface;
  }

  // The normal is computed from the longest edge and the height above it. This is accurate for needles too.
  void try_face() {
    int p = 0;
    double longest = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double length = (corner((i + 1) % 3) - corner(i)).squaredNorm();
      if (length > longest) {
        longest = length;
        p = i;
      }
    }
    const int q = (p + 1) % 3;
    const int r = (p + 2) % 3;
    const double length = std::sqrt(longest);
    if (!(length > 0.0)) return;
    const Vector3 along = (corner(q) - corner(p)) / length;
    const Vector3 side = corner(r) - corner(p);
    const double foot = along.dot(side);
    const Vector3 rise = side - foot * along;
    const double rise2 = rise.squaredNorm();
    if (!(rise2 > 0.0)) return;
    // All shapes contain their origin, so the origin is below the separating plane.
    Vector3 normal = along.cross(rise).normalized();
    if (normal.dot(corner(p)) < 0.0) normal = -normal;

    try_direction(normal);
    const Vector3 point = support_point(shape_, normal);
    const Vector3 from_p = point - corner(p);
    Vector3 weights;
    weights[r] = rise.dot(from_p) / rise2;
    weights[q] = (along.dot(from_p) - weights[r] * foot) / length;
    weights[p] = 1.0 - weights[q] - weights[r];
    const double distance = -normal.dot(from_p);
    if (distance > 0.0 && weights.minCoeff() >= 0.0) try_pair(point, weights, distance);
  }

  void try_edge(int i, int j) {
    const double length = (corner(j) - corner(i)).norm();
    if (!(length > 0.0)) return;
    const Vector3 direction = (corner(j) - corner(i)) / length;
    const SurfacePoint& begin = at_corner_[static_cast<std::size_t>(i)];
    const SurfacePoint& end = at_corner_[static_cast<std::size_t>(j)];
    const EdgeSample low{0.0, begin.distance, direction.dot(begin.normal)};
    const EdgeSample high{length, end.distance, direction.dot(end.normal)};
    if (low.slope >= 0.0 || high.slope <= 0.0) return;
    if (crossing_of_tangents(low, high).distance >= kProvenFraction * best_.distance) return;

    ConvexLineSearch bracket(low, high);
    Vector3 normal = begin.normal;
    for (int step = 0; step < kMaxEdgeSteps; ++step) {
      const double at = bracket.next();
      if (!bracket.contains(at)) break;
      const SurfacePoint surface = surface_point(shape_, corner(i) + at * direction);
      normal = surface.normal;
      const double slope = direction.dot(normal);
      bracket.cut({at, surface.distance, slope});
      try_pair(surface.point, (1.0 - at / length) * Vector3::Unit(i) + at / length * Vector3::Unit(j), surface.distance);
      const double max_decrease = slope < 0.0 ? -slope * (length - at) : slope * at;
      if (max_decrease <= (1.0 - kProvenFraction) * surface.distance) {
        try_direction(normal);
        return;
      }
    }
    try_perpendicular(normal, direction);
  }

  // If the edge nearly touches the shape, the normal is inaccurate. The separating direction is perpendicular to the edge.
  void try_perpendicular(const Vector3& along, const Vector3& edge) {
    const Vector3 normal = along - edge.dot(along) * edge;
    const double length = normal.norm();
    if (length > 0.0) try_direction(normal / length);
  }

  void try_both_directions(const Vector3& across) {
    const double length = across.norm();
    if (!(length > 0.0)) return;
    try_direction(across / length);
    try_direction(-across / length);
  }

  const Shape& shape_;
  const ElementCorners& element_;
  std::array<SurfacePoint, 3> at_corner_{};
  SeparatingPlane best_;
};

}  // namespace

double lowest(const Box3& box, const Vector3& normal) {
  return normal.dot(box.center()) - 0.5 * normal.cwiseAbs().dot(box.sizes());
}

template <class Shape>
SeparatingPlane separation(const Shape& shape, const ElementCorners& element, const Box3& box) {
  SeparationSearch<Shape> search(shape, element);
  if (!(lowest(box, search.best().normal) > search.best().height)) search.finish();
  return search.best();
}

template SeparatingPlane separation(const SphereGeometry& sphere, const ElementCorners& element, const Box3& box);
template SeparatingPlane separation(const BoxGeometry& solid, const ElementCorners& element, const Box3& box);
template SeparatingPlane separation(const CapsuleGeometry& capsule, const ElementCorners& element, const Box3& box);
template SeparatingPlane separation(const CylinderGeometry& cylinder, const ElementCorners& element, const Box3& box);
template SeparatingPlane separation(const ConeGeometry& cone, const ElementCorners& element, const Box3& box);
template SeparatingPlane separation(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const Box3& box);

SeparatingPlane separation(const HalfSpaceGeometry& half_space, const ElementCorners& element, const Box3& /*box*/) {
  const int at = lowest_corner(element, half_space.normal);
  const Vector3& x = element.x[static_cast<std::size_t>(at)];
  const double low = half_space.normal.dot(x);
  const double gap = low - half_space.offset;
  return {half_space.normal, x - gap * half_space.normal, Vector3::Unit(at), half_space.offset, low, at, gap, gap};
}

}  // namespace sprung
