#include "collision/shapes/obstacle.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sprung {
namespace {

using Vector2 = Eigen::Vector2d;

constexpr Index kAround = 48;   // sides of a solid of revolution
constexpr Index kQuarter = 12;  // steps of a quarter circle from pole to equator

/// Rotates a profile about the y axis. The profile consists of points (distance from the axis, height), from the lowest point on
/// the axis to the highest.
TriangleMesh revolve(const std::vector<Vector2>& profile) {
  const auto rings = static_cast<Index>(profile.size()) - 2;
  const Index bottom = rings * kAround;
  const Index top = bottom + 1;
  TriangleMesh mesh{Points(3, top + 1), Triangles(3, 2 * kAround * rings)};
  for (Index ring = 0; ring < rings; ++ring) {
    const Vector2& at = profile[ring + 1];
    for (Index side = 0; side < kAround; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kAround;
      mesh.vertices.col(ring * kAround + side) = Vector3(at.x() * std::sin(angle), at.y(), at.x() * std::cos(angle));
    }
  }
  mesh.vertices.col(bottom) = Vector3(0.0, profile.front().y(), 0.0);
  mesh.vertices.col(top) = Vector3(0.0, profile.back().y(), 0.0);

  Index t = 0;
  for (Index side = 0; side < kAround; ++side) {
    const Index next = (side + 1) % kAround;
    mesh.triangles.col(t++) << bottom, next, side;
    for (Index low = 0; low + kAround < bottom; low += kAround) {
      mesh.triangles.col(t++) << low + side, low + next, low + kAround + next;
      mesh.triangles.col(t++) << low + side, low + kAround + next, low + kAround + side;
    }
    mesh.triangles.col(t++) << top, bottom - kAround + side, bottom - kAround + next;
  }
  return mesh;
}

/// A half circle from pole to pole. Its halves are `length` [m] apart.
std::vector<Vector2> half_circle(double radius, double length) {
  std::vector<Vector2> profile;
  for (Index i = -kQuarter; i <= kQuarter; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kQuarter;
    const Vector2 point =
        i == -kQuarter || i == kQuarter ? Vector2(0.0, i < 0 ? -1.0 : 1.0) : Vector2(std::cos(angle), std::sin(angle));
    if (i <= 0) profile.emplace_back(radius * point - Vector2(0.0, 0.5 * length));
    if (i > 0 || (i == 0 && length > 0.0)) profile.emplace_back(radius * point + Vector2(0.0, 0.5 * length));
  }
  return profile;
}

TriangleMesh tessellate(const MeshGeometry& geometry, double /*extent*/, double /*time*/) { return *geometry.mesh; }

TriangleMesh tessellate(const SequenceGeometry& geometry, double /*extent*/, double time) {
  TriangleMesh mesh{{}, geometry.sequence->triangles};
  geometry.sequence->positions(geometry.sequence->at(time), mesh.vertices);
  return mesh;
}

TriangleMesh tessellate(const SphereGeometry& sphere, double /*extent*/, double /*time*/) {
  return revolve(half_circle(sphere.radius, 0.0));
}

TriangleMesh tessellate(const CapsuleGeometry& capsule, double /*extent*/, double /*time*/) {
  return revolve(half_circle(capsule.radius, capsule.length));
}

TriangleMesh tessellate(const CylinderGeometry& cylinder, double /*extent*/, double /*time*/) {
  const double half = 0.5 * cylinder.height;
  return revolve({{0.0, -half}, {cylinder.radius, -half}, {cylinder.radius, half}, {0.0, half}});
}

TriangleMesh tessellate(const ConeGeometry& cone, double /*extent*/, double /*time*/) {
  const double half = 0.5 * cone.height;
  return revolve({{0.0, -half}, {cone.radius, -half}, {0.0, half}});
}

TriangleMesh tessellate(const EllipsoidGeometry& ellipsoid, double /*extent*/, double /*time*/) {
  TriangleMesh mesh = revolve(half_circle(1.0, 0.0));
  mesh.vertices = ellipsoid.radii.asDiagonal() * mesh.vertices;
  return mesh;
}

TriangleMesh tessellate(const BoxGeometry& box, double /*extent*/, double /*time*/) {
  TriangleMesh mesh{Points(3, 8), Triangles(3, 12)};
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
    mesh.vertices.col(i) = corner.cwiseProduct(box.size);
  }
  constexpr std::array<std::array<Index, 4>, 6> kSides{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (Index side = 0; side < 6; ++side) {
    const auto& [a, b, c, d] = kSides[side];
    mesh.triangles.col(2 * side) << a, b, c;
    mesh.triangles.col(2 * side + 1) << a, c, d;
  }
  return mesh;
}

TriangleMesh tessellate(const HalfSpaceGeometry& half_space, double extent, double /*time*/) {
  const Vector3 u = half_space.normal.unitOrthogonal();
  const Vector3 v = half_space.normal.cross(u);
  const Vector3 centre = half_space.offset * half_space.normal;
  TriangleMesh mesh{Points(3, 4), Triangles(3, 2)};
  mesh.vertices << centre - extent * (u + v), centre + extent * (u - v), centre + extent * (u + v), centre - extent * (u - v);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

}  // namespace

TriangleMesh obstacle_mesh(const ObstacleGeometry& geometry, double extent, double time) {
  return std::visit([=](const auto& of_kind) { return tessellate(of_kind, extent, time); }, geometry);
}

bool Obstacle::deforms() const {
  const auto* mesh = std::get_if<SequenceGeometry>(&geometry);
  return mesh != nullptr && mesh->sequence->deforms();
}

}  // namespace sprung
