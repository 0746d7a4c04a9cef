#include "collision/primitive_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace sprung {

namespace {

using Vector2 = Eigen::Vector2d;

/// The surface of a ball around `centre`, whose own nearest point is in the direction `from_centre`.
SurfacePoint ball_surface(const Vector3& centre, double radius, const Vector3& p, const Vector3& from_centre) {
  const Vector3 away = p - centre;
  const double length = away.norm();
  const Vector3 normal = length > 0.0 ? Vector3(away / length) : from_centre;
  return {centre + radius * normal, normal, length - radius};
}

/// A point and a normal in the half-plane of a solid of revolution: distance from the axis, height.
struct ProfilePoint {
  Vector2 point = Vector2::Zero();
  Vector2 normal = Vector2::Zero();
  double distance = 0.0;
};

/// The nearest point of a convex profile, given as the corners of its rim from the axis round to the axis, solid on the left.
/// Beside a corner, directions of lengths below `rounding` may leave the range between the corner's sides.
ProfilePoint profile_surface(std::span<const Vector2> rim, const Vector2& p, double rounding) {
  ProfilePoint plane{.distance = -std::numeric_limits<double>::infinity()};
  ProfilePoint nearest{.distance = std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k + 1 < rim.size(); ++k) {
    const Vector2 along = rim[k + 1] - rim[k];
    const Vector2 normal = Vector2(along.y(), -along.x()).normalized();
    const double height = normal.dot(p - rim[k]);
    if (height > plane.distance) plane = {p - height * normal, normal, height};

    const double t = along.dot(p - rim[k]) / along.squaredNorm();
    const Vector2 point = t <= 0.0 ? rim[k] : t >= 1.0 ? rim[k + 1] : Vector2(rim[k] + t * along);
    const double distance = (p - point).norm();
    // Beside a side, not a corner, the direction is the side's own, which close to it is far better than that of a short
    // difference.
    const bool beside = t > 0.0 && t < 1.0;
    if (distance < nearest.distance) nearest = {point, beside ? normal : Vector2((p - point) / distance), distance};
  }
  if (plane.distance <= 0.0) return plane;
  if (nearest.distance <= rounding) nearest.normal = plane.normal;
  return nearest;
}

/// The profile's answer for a point in space, turned about the y axis.
SurfacePoint revolved_surface(std::span<const Vector2> rim, const Vector3& p) {
  const double radius = std::hypot(p.x(), p.z());
  const Vector3 outward = radius > 0.0 ? Vector3(p.x() / radius, 0.0, p.z() / radius) : Vector3::UnitX();
  const double rounding = 1e-12 * p.norm();
  const ProfilePoint found = profile_surface(rim, Vector2(radius, p.y()), rounding);
  const auto in_space = [&](const Vector2& q) { return Vector3(q.x() * outward + q.y() * Vector3::UnitY()); };
  return {in_space(found.point), in_space(found.normal), found.distance};
}

Box3 centred_box(double x, double y, double z) { return {Vector3(-x, -y, -z), Vector3(x, y, z)}; }

}  // namespace

SurfacePoint surface_point(const SphereGeometry& sphere, const Vector3& p) {
  return ball_surface(Vector3::Zero(), sphere.radius, p, Vector3::UnitY());
}

SurfacePoint surface_point(const CapsuleGeometry& capsule, const Vector3& p) {
  const double half = 0.5 * capsule.length;
  return ball_surface(std::clamp(p.y(), -half, half) * Vector3::UnitY(), capsule.radius, p, Vector3::UnitX());
}

SurfacePoint surface_point(const BoxGeometry& box, const Vector3& p) {
  const Vector3 half = 0.5 * box.size;
  const Vector3 beyond = p.cwiseAbs() - half;
  Index axis = 0;
  const double highest = beyond.maxCoeff(&axis);
  const Vector3 face = (p[axis] < 0.0 ? -1.0 : 1.0) * Vector3::Unit(axis);
  if (highest <= 0.0) {
    Vector3 point = p;
    point[axis] = face[axis] * half[axis];
    return {point, face, highest};
  }
  const Vector3 point = p.cwiseMax(-half).cwiseMin(half);
  const double distance = (p - point).norm();
  return {point, (p - point) / distance, distance};
}

SurfacePoint surface_point(const CylinderGeometry& cylinder, const Vector3& p) {
  const double half = 0.5 * cylinder.height;
  const std::array<Vector2, 4> rim{Vector2(0.0, -half), Vector2(cylinder.radius, -half), Vector2(cylinder.radius, half),
                                   Vector2(0.0, half)};
  return revolved_surface(rim, p);
}

SurfacePoint surface_point(const ConeGeometry& cone, const Vector3& p) {
  const double half = 0.5 * cone.height;
  const std::array<Vector2, 3> rim{Vector2(0.0, -half), Vector2(cone.radius, -half), Vector2(0.0, half)};
  return revolved_surface(rim, p);
}

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

}  // namespace sprung
