#include "collision/primitives/primitive_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

using Vector2 = Eigen::Vector2d;

/// The point of a sphere nearest to p. If p is the centre, the point is in the direction `from_centre`.
SurfacePoint sphere_surface(const Vector3& centre, double radius, const Vector3& p, const Vector3& from_centre) {
  const Vector3 away = p - centre;
  const double length = away.norm();
  const Vector3 normal = length > 0.0 ? Vector3(away / length) : from_centre;
  return {centre + radius * normal, normal, length - radius};
}

/// A point of a solid of revolution in its half-plane (distance from the axis, height).
struct ProfilePoint {
  Vector2 point = Vector2::Zero();
  Vector2 normal = Vector2::Zero();
  double distance = 0.0;
};

/// The distance from a corner of the profile, for a point outside. Below the length `rounding` the direction is inaccurate, and
/// the normal is `side`.
ProfilePoint at_corner(const Vector2& corner, const Vector2& p, const Vector2& side, double rounding) {
  const double distance = (p - corner).norm();
  return {corner, distance > rounding ? Vector2((p - corner) / distance) : side, distance};
}

ProfilePoint profile_surface(const CylinderGeometry& cylinder, const Vector2& p, double rounding) {
  const double cap = std::copysign(0.5 * cylinder.height, p.y());
  const double beyond_wall = p.x() - cylinder.radius;
  const double beyond_cap = std::abs(p.y()) - 0.5 * cylinder.height;
  const Vector2 up(0.0, std::copysign(1.0, p.y()));
  if (beyond_wall > 0.0 && beyond_cap > 0.0) {
    return at_corner(Vector2(cylinder.radius, cap), p, beyond_wall > beyond_cap ? Vector2::UnitX() : up, rounding);
  }
  if (beyond_wall > beyond_cap) return {Vector2(cylinder.radius, p.y()), Vector2::UnitX(), beyond_wall};
  return {Vector2(p.x(), cap), up, beyond_cap};
}

ProfilePoint profile_surface(const ConeGeometry& cone, const Vector2& p, double rounding) {
  const Vector2 rim(cone.radius, -0.5 * cone.height);
  const Vector2 tip(0.0, 0.5 * cone.height);
  const double slant = (tip - rim).norm();
  const Vector2 along = (tip - rim) / slant;
  const Vector2 outward(along.y(), -along.x());
  const Vector2 down(0.0, -1.0);
  const double above_side = outward.dot(p - rim);
  const double below_base = rim.y() - p.y();
  const double foot = along.dot(p - rim);
  const bool outside = above_side > 0.0 || below_base > 0.0;
  if (outside && foot <= 0.0 && p.x() >= rim.x()) return at_corner(rim, p, above_side > below_base ? outward : down, rounding);
  if (outside && foot >= slant) return at_corner(tip, p, outward, rounding);
  if (outside ? below_base > 0.0 && p.x() < rim.x() : below_base >= above_side) return {Vector2(p.x(), rim.y()), down, below_base};
  return {p - above_side * outward, outward, above_side};
}

/// Rotates the result for the profile about the y axis.
template <class Solid>
SurfacePoint revolved_surface(const Solid& solid, const Vector3& p) {
  const double radius = std::sqrt(p.x() * p.x() + p.z() * p.z());
  const Vector3 outward = radius > 0.0 ? Vector3(p.x() / radius, 0.0, p.z() / radius) : Vector3::UnitX();
  const double rounding = 1e-12 * p.norm();
  const ProfilePoint found = profile_surface(solid, Vector2(radius, p.y()), rounding);
  const auto in_space = [&](const Vector2& q) { return Vector3(q.x() * outward.x(), q.y(), q.x() * outward.z()); };
  return {in_space(found.point), in_space(found.normal), found.distance};
}

Box3 centred_box(double x, double y, double z) { return {Vector3(-x, -y, -z), Vector3(x, y, z)}; }

/// The point of a circle about the y axis that is farthest in `direction`.
Vector3 on_circle(double radius, double height, const Vector3& direction) {
  const double across = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  if (!(across > 0.0)) return {radius, height, 0.0};
  const double scale = radius / across;
  return {scale * direction.x(), height, scale * direction.z()};
}

/// The sum of (z_i / (u + gap_i))^2 minus 1, and its derivative. Terms with z_i = 0 vanish, even at their pole.
struct Secular {
  double value = -1.0;
  double slope = 0.0;
};

Secular secular(const Vector3& z, const Vector3& gap, double u) {
  Secular sum;
  for (int i = 0; i < 3; ++i) {
    if (z[i] == 0.0) continue;
    const double ratio = z[i] / (u + gap[i]);
    sum.value += ratio * ratio;
    sum.slope -= 2.0 * ratio * ratio / (u + gap[i]);
  }
  return sum;
}

/// The largest root, or 0 if the function is negative from 0 on. Right of the last pole the function is convex and decreasing, so
/// Newton steps from the left never pass the root. Rounding ends the iteration.
double largest_root(const Vector3& z, const Vector3& gap) {
  double u = std::max((z - gap).maxCoeff(), 0.0);
  if (u == 0.0 && !(secular(z, gap, u).value > 0.0)) return 0.0;
  for (;;) {
    const Secular at = secular(z, gap, u);
    if (!(at.value > 0.0)) return u;
    const double next = u - at.value / at.slope;
    if (!(next > u)) return u;
    u = next;
  }
}

/// The point of the ellipsoid nearest to p, with p in the first octant and radii in decreasing order. The nearest point x
/// satisfies p - x = t (x_i / r_i^2), so x_i = r_i^2 p_i / (t + r_i^2) with the largest t for which x is on the surface (Eberly,
/// "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). In units of the smallest radius, u = t / r_3^2
/// + 1.
Vector3 nearest_in_octant(const Vector3& radii, const Vector3& p) {
  const Vector3 scale = radii / radii[2];
  const Vector3 gap = scale.array().square() - 1.0;
  const Vector3 z = scale.cwiseProduct(p / radii[2]);
  const double u = largest_root(z, gap);
  Vector3 x = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (z[i] > 0.0) x[i] = scale[i] * scale[i] * p[i] / (u + gap[i]);
  }
  // On the medial disc two points are nearest, one above and one below it.
  if (u == 0.0) x[2] = radii[2] * std::sqrt(std::max(-secular(z, gap, 0.0).value, 0.0));
  return x;
}

}  // namespace

SurfacePoint surface_point(const SphereGeometry& sphere, const Vector3& p) {
  return sphere_surface(Vector3::Zero(), sphere.radius, p, Vector3::UnitY());
}

SurfacePoint surface_point(const CapsuleGeometry& capsule, const Vector3& p) {
  const double half = 0.5 * capsule.length;
  return sphere_surface(std::clamp(p.y(), -half, half) * Vector3::UnitY(), capsule.radius, p, Vector3::UnitX());
}

SurfacePoint surface_point(const BoxGeometry& box, const Vector3& p) {
  const Vector3 half = 0.5 * box.size;
  const Vector3 nearest = p.cwiseMax(-half).cwiseMin(half);
  const double outside = (p - nearest).norm();
  if (outside > 0.0) return {nearest, (p - nearest) / outside, outside};
  Index axis = 0;
  const double highest = (p.cwiseAbs() - half).maxCoeff(&axis);
  const Vector3 face = (p[axis] < 0.0 ? -1.0 : 1.0) * Vector3::Unit(axis);
  Vector3 point = p;
  point[axis] = face[axis] * half[axis];
  return {point, face, highest};
}

SurfacePoint surface_point(const CylinderGeometry& cylinder, const Vector3& p) { return revolved_surface(cylinder, p); }

SurfacePoint surface_point(const ConeGeometry& cone, const Vector3& p) { return revolved_surface(cone, p); }

SurfacePoint surface_point(const HalfSpaceGeometry& half_space, const Vector3& p) {
  const double height = half_space.normal.dot(p) - half_space.offset;
  return {p - height * half_space.normal, half_space.normal, height};
}

Box3 bounds(const SphereGeometry& sphere) { return centred_box(sphere.radius, sphere.radius, sphere.radius); }

Box3 bounds(const BoxGeometry& box) { return {-0.5 * box.size, 0.5 * box.size}; }

Box3 bounds(const CapsuleGeometry& capsule) {
  return centred_box(capsule.radius, 0.5 * capsule.length + capsule.radius, capsule.radius);
}

Box3 bounds(const CylinderGeometry& cylinder) { return centred_box(cylinder.radius, 0.5 * cylinder.height, cylinder.radius); }

Box3 bounds(const ConeGeometry& cone) { return centred_box(cone.radius, 0.5 * cone.height, cone.radius); }

Box3 bounds(const EllipsoidGeometry& ellipsoid) { return {-ellipsoid.radii, ellipsoid.radii}; }

Box3 bounds(const HalfSpaceGeometry& /*half_space*/) {
  return {Vector3::Constant(-std::numeric_limits<double>::infinity()), Vector3::Constant(std::numeric_limits<double>::infinity())};
}

Vector3 support_point(const SphereGeometry& sphere, const Vector3& direction) { return sphere.radius * direction.normalized(); }

Vector3 support_point(const BoxGeometry& box, const Vector3& direction) {
  return 0.5 * box.size.cwiseProduct(direction.unaryExpr([](double component) { return std::copysign(1.0, component); }));
}

Vector3 support_point(const CapsuleGeometry& capsule, const Vector3& direction) {
  const double cap = std::copysign(0.5 * capsule.length, direction.y());
  return cap * Vector3::UnitY() + capsule.radius * direction.normalized();
}

Vector3 support_point(const CylinderGeometry& cylinder, const Vector3& direction) {
  return on_circle(cylinder.radius, std::copysign(0.5 * cylinder.height, direction.y()), direction);
}

Vector3 support_point(const ConeGeometry& cone, const Vector3& direction) {
  const Vector3 tip(0.0, 0.5 * cone.height, 0.0);
  const Vector3 rim = on_circle(cone.radius, -0.5 * cone.height, direction);
  return direction.dot(tip) >= direction.dot(rim) ? tip : rim;
}

Vector3 support_point(const EllipsoidGeometry& ellipsoid, const Vector3& direction) {
  const Vector3 scaled = ellipsoid.radii.cwiseProduct(direction);
  return ellipsoid.radii.cwiseProduct(scaled / scaled.norm());
}

std::optional<Crossing> first_crossing_of_convex(const std::function<SurfacePoint(const Vector3&)>& distance, double rounding,
                                                 const Vector3& a, const Vector3& b) {
  if (a == b) return std::nullopt;
  const Vector3 path = b - a;
  double fraction = 0.0;
  SurfacePoint surface = distance(a);
  if (surface.distance < -rounding) return std::nullopt;
  // Newton's method converges quadratically, except on a path that grazes the surface. There each step halves the rest, and 64
  // halvings are enough.
  for (int step = 0; step < 64 && surface.distance > rounding; ++step) {
    const double slope = surface.normal.dot(path);
    const double height = surface.distance - 0.5 * rounding;
    if (height + slope * (1.0 - fraction) > 0.0) return std::nullopt;
    fraction = std::min(fraction - height / slope, 1.0);
    surface = distance(a + fraction * path);
  }
  if (fraction == 0.0 && surface.normal.dot(path) >= 0.0) return std::nullopt;
  return Crossing{fraction, surface.point, surface.normal};
}

SurfacePoint surface_point(const EllipsoidGeometry& ellipsoid, const Vector3& p) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return ellipsoid.radii[i] > ellipsoid.radii[j]; });
  Vector3 radii;
  Vector3 folded;
  for (int i = 0; i < 3; ++i) {
    radii[i] = ellipsoid.radii[order[i]];
    folded[i] = std::abs(p[order[i]]);
  }
  const Vector3 nearest = nearest_in_octant(radii, folded);

  SurfacePoint found;
  for (int i = 0; i < 3; ++i) found.point[order[i]] = std::signbit(p[order[i]]) ? -nearest[i] : nearest[i];
  // The gradient of the sum of (x_i / r_i)^2. It has a direction even if p is on the surface.
  const Vector3 unit = found.point.cwiseQuotient(ellipsoid.radii);
  found.normal = unit.cwiseQuotient(ellipsoid.radii / radii[2]).normalized();
  found.distance = found.normal.dot(p - found.point);
  return found;
}

}  // namespace sprung
