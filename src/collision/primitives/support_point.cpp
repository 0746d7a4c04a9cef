#include "collision/primitives/support_point.h"

#include <cmath>

namespace sprung {

namespace {

/// The point of a circle about the y axis that is farthest in `direction`.
Vector3 on_circle(double radius, double height, const Vector3& direction) {
  const double across = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  if (!(across > 0.0)) return {radius, height, 0.0};
  const double scale = radius / across;
  return {scale * direction.x(), height, scale * direction.z()};
}

}  // namespace

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

}  // namespace sprung
