#include "collision/primitives/convex_separating_plane.h"

#include "collision/primitives/convex_line_search.h"
#include "collision/primitives/primitive_distance.h"
#include "collision/primitives/support_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sprung {

namespace {

// A separation is good enough once it proves this part of the distance.
constexpr double kProven = 0.998;

// Each three steps along an edge halve what is left of it at least; two or three are usual.
constexpr int kMostEdgeSteps = 150;

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

/// Directions in which the shape's surface is straight at or beside a point of it. Close to touching, what separates it from what
/// is flat is perpendicular to two of them, or to one and an edge, and so is known to rounding, where points that are nearly the
/// same do not tell it. Of boxes these are all that can separate (Gottschalk, Lin and Manocha 1996).
template <class Shape>
std::vector<Vector3> straight_lines(const Shape& /*shape*/, const Vector3& /*point*/) {
  return {};
}

std::vector<Vector3> straight_lines(const BoxGeometry& /*box*/, const Vector3& /*point*/) {
  return {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
}

/// `slope`: how far out the side goes a metre up.
std::vector<Vector3> straight_lines_of_round_side(const Vector3& point, double slope) {
  const double radius = std::hypot(point.x(), point.z());
  const Vector3 outward = radius > 0.0 ? Vector3(point.x() / radius, 0.0, point.z() / radius) : Vector3::UnitX();
  return {outward, outward.cross(Vector3::UnitY()), Vector3::UnitY() + slope * outward};
}

std::vector<Vector3> straight_lines(const CylinderGeometry& /*cylinder*/, const Vector3& point) {
  return straight_lines_of_round_side(point, 0.0);
}

std::vector<Vector3> straight_lines(const ConeGeometry& cone, const Vector3& point) {
  return straight_lines_of_round_side(point, -cone.radius / cone.height);
}

template <class Shape>
class SeparationSearch {
 public:
  SeparationSearch(const Shape& shape, const ElementCorners& element) : shape_(shape), element_(element) { look_at_corner(0); }

  [[nodiscard]] const SeparatingPlane& best() const { return best_; }

  void finish() {
    if (element_.count == 3 && !settled()) look_at_face();
    for (int i = 1; i < element_.count && !settled(); ++i) look_at_corner(i);
    const int edges = element_.count == 3 ? 3 : element_.count - 1;
    for (int i = 0; i < edges && !settled(); ++i) look_along_edge(i, (i + 1) % element_.count);
    if (settled()) return;
    const std::vector<Vector3> lines = straight_lines(shape_, best_.point);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      offer_both(lines[k].cross(lines[(k + 1) % lines.size()]));
      for (int i = 0; i < edges; ++i) offer_both(lines[k].cross(corner((i + 1) % element_.count) - corner(i)));
    }
  }

 private:
  [[nodiscard]] bool settled() const { return best_.gap > 0.0 && best_.gap >= kProven * best_.distance; }
  [[nodiscard]] const Vector3& corner(int i) const { return element_.x[static_cast<std::size_t>(i)]; }

  void offer_direction(const Vector3& normal) {
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

  void offer_pair(const Vector3& point, const Vector3& weights, double distance) {
    if (!(distance < best_.distance)) return;
    best_.point = point;
    best_.weights = weights;
    best_.distance = distance;
  }

  void look_at_corner(int i) {
    const SurfacePoint surface = surface_point(shape_, corner(i));
    offer_direction(surface.normal);
    offer_pair(surface.point, Vector3::Unit(i), surface.distance);
    at_corner_[static_cast<std::size_t>(i)] = surface;
  }

  // The normal is taken from the longest side and the height on it, which is right to rounding for needles too.
  void look_at_face() {
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
    // All shapes hold their origin, so what separates them has the origin below it.
    Vector3 normal = along.cross(rise).normalized();
    if (normal.dot(corner(p)) < 0.0) normal = -normal;

    offer_direction(normal);
    const Vector3 point = support_point(shape_, normal);
    const Vector3 from_p = point - corner(p);
    Vector3 weights;
    weights[r] = rise.dot(from_p) / rise2;
    weights[q] = (along.dot(from_p) - weights[r] * foot) / length;
    weights[p] = 1.0 - weights[q] - weights[r];
    const double distance = -normal.dot(from_p);
    if (distance > 0.0 && weights.minCoeff() >= 0.0) offer_pair(point, weights, distance);
  }

  void look_along_edge(int i, int j) {
    const double length = (corner(j) - corner(i)).norm();
    if (!(length > 0.0)) return;
    const Vector3 direction = (corner(j) - corner(i)) / length;
    const SurfacePoint& begin = at_corner_[static_cast<std::size_t>(i)];
    const SurfacePoint& end = at_corner_[static_cast<std::size_t>(j)];
    const EdgeSample low{0.0, begin.distance, direction.dot(begin.normal)};
    const EdgeSample high{length, end.distance, direction.dot(end.normal)};
    if (low.slope >= 0.0 || high.slope <= 0.0) return;
    if (crossing_of_tangents(low, high).distance >= kProven * best_.distance) return;

    ConvexLineSearch bracket(low, high);
    Vector3 normal = begin.normal;
    for (int step = 0; step < kMostEdgeSteps; ++step) {
      const double at = bracket.next();
      if (!bracket.holds(at)) break;
      const SurfacePoint surface = surface_point(shape_, corner(i) + at * direction);
      normal = surface.normal;
      const double slope = direction.dot(normal);
      bracket.cut({at, surface.distance, slope});
      offer_pair(surface.point, (1.0 - at / length) * Vector3::Unit(i) + at / length * Vector3::Unit(j), surface.distance);
      const double may_fall = slope < 0.0 ? -slope * (length - at) : slope * at;
      if (may_fall <= (1.0 - kProven) * surface.distance) {
        offer_direction(normal);
        return;
      }
    }
    offer_refined(normal, direction);
  }

  // Close to touching, a normal between edge and shape is mostly rounding. It is perpendicular to the edge.
  void offer_refined(const Vector3& along, const Vector3& edge) {
    const Vector3 normal = along - edge.dot(along) * edge;
    const double length = normal.norm();
    if (length > 0.0) offer_direction(normal / length);
  }

  void offer_both(const Vector3& across) {
    const double length = across.norm();
    if (!(length > 0.0)) return;
    offer_direction(across / length);
    offer_direction(-across / length);
  }

  const Shape& shape_;
  const ElementCorners& element_;
  std::array<SurfacePoint, 3> at_corner_{};
  SeparatingPlane best_;
};

template <class Shape>
SeparatingPlane search(const Shape& shape, const ElementCorners& element, const Box3& box) {
  SeparationSearch<Shape> search(shape, element);
  if (!(lowest(box, search.best().normal) > search.best().height)) search.finish();
  return search.best();
}

}  // namespace

double lowest(const Box3& box, const Vector3& normal) {
  return normal.dot(box.center()) - 0.5 * normal.cwiseAbs().dot(box.sizes());
}

SeparatingPlane separation(const SphereGeometry& sphere, const ElementCorners& element, const Box3& box) {
  return search(sphere, element, box);
}
SeparatingPlane separation(const BoxGeometry& solid, const ElementCorners& element, const Box3& box) {
  return search(solid, element, box);
}
SeparatingPlane separation(const CapsuleGeometry& capsule, const ElementCorners& element, const Box3& box) {
  return search(capsule, element, box);
}
SeparatingPlane separation(const CylinderGeometry& cylinder, const ElementCorners& element, const Box3& box) {
  return search(cylinder, element, box);
}
SeparatingPlane separation(const ConeGeometry& cone, const ElementCorners& element, const Box3& box) {
  return search(cone, element, box);
}
SeparatingPlane separation(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const Box3& box) {
  return search(ellipsoid, element, box);
}

SeparatingPlane separation(const HalfSpaceGeometry& half_space, const ElementCorners& element, const Box3& /*box*/) {
  const int at = lowest_corner(element, half_space.normal);
  const Vector3& x = element.x[static_cast<std::size_t>(at)];
  const double low = half_space.normal.dot(x);
  const double gap = low - half_space.offset;
  return {half_space.normal, x - gap * half_space.normal, Vector3::Unit(at), half_space.offset, low, at, gap, gap};
}

}  // namespace sprung
