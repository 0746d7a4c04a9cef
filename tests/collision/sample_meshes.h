// Test meshes, points near them, and reference answers by brute force over all triangles.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

namespace sprung::test {

/// Random numbers that are the same on every machine, unlike those of std's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Index below(Index count) { return static_cast<Index>(engine_() % static_cast<std::uint64_t>(count)); }
  Vector3 in_box(const Box3& box) {
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = between(box.min()[axis], box.max()[axis]);
    return p;
  }
  Vector3 direction() {
    for (;;) {
      const Vector3 v = in_box({Vector3::Constant(-1.0), Vector3::Constant(1.0)});
      if (v.norm() <= 1.0 && v.norm() > 0.1) return v.normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// The same faces as polygons.
inline PolygonMesh polygons(const TriangleMesh& triangles) {
  PolygonMesh mesh;
  mesh.vertices = triangles.vertices;
  for (const auto& corners : triangles.triangles.colwise()) {
    mesh.faces.vertex.insert(mesh.faces.vertex.end(), corners.begin(), corners.end());
    mesh.faces.corner_begin.push_back(static_cast<Index>(mesh.faces.vertex.size()));
  }
  return mesh;
}

/// A closed torus about the y axis, with outward normals.
inline TriangleMesh torus(double radius, double tube, Index around, Index across) {
  TriangleMesh mesh{Points(3, around * across), Triangles(3, 2 * around * across)};
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around;
      const double v = 2.0 * std::numbers::pi * j / across;
      const double r = radius + tube * std::cos(v);
      mesh.vertices.col(i * across + j) = Vector3(r * std::cos(u), tube * std::sin(v), r * std::sin(u));
      const Index a = i * across + j;
      const Index b = (i + 1) % around * across + j;
      const Index c = (i + 1) % around * across + (j + 1) % across;
      const Index d = i * across + (j + 1) % across;
      mesh.triangles.col(2 * a) << a, d, b;
      mesh.triangles.col(2 * a + 1) << b, d, c;
    }
  }
  return mesh;
}

/// An open square in the x-z plane of `side` x `side` squares of size 1 about the origin, with heights `height(i, j)`, facing up.
template <class Height>
TriangleMesh terrain(Index side, const Height& height) {
  TriangleMesh mesh{Points(3, (side + 1) * (side + 1)), Triangles(3, 2 * side * side)};
  for (Index j = 0; j <= side; ++j) {
    for (Index i = 0; i <= side; ++i) mesh.vertices.col(j * (side + 1) + i) = Vector3(i - side / 2, height(i, j), j - side / 2);
  }
  for (Index j = 0; j < side; ++j) {
    for (Index i = 0; i < side; ++i) {
      const Index a = j * (side + 1) + i;
      const Index t = 2 * (j * side + i);
      mesh.triangles.col(t) << a, a + side + 1, a + 1;
      mesh.triangles.col(t + 1) << a + 1, a + side + 1, a + side + 2;
    }
  }
  return mesh;
}

inline TriangleMesh flat_sheet(Index side) {
  return terrain(side, [](Index, Index) { return 0.0; });
}

/// A closed ball of needles: every third vertex of a sphere is pulled outward. Outward normals.
inline TriangleMesh needles(Index around) {
  const Index rings = around / 2 - 1;
  TriangleMesh star{Points(3, rings * around + 2), Triangles(3, 2 * rings * around)};
  for (Index ring = 0; ring < rings; ++ring) {
    const double polar = std::numbers::pi * (ring + 1) / (rings + 1);
    for (Index i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / around;
      const double radius = (ring * around + i) % 3 == 0 ? 1.0 : 0.05;
      star.vertices.col(ring * around + i) =
          radius * Vector3(std::sin(polar) * std::sin(angle), -std::cos(polar), std::sin(polar) * std::cos(angle));
    }
  }
  const Index south = rings * around;
  const Index north = south + 1;
  star.vertices.col(south) = Vector3(0.0, -0.05, 0.0);
  star.vertices.col(north) = Vector3(0.0, 0.05, 0.0);
  Index t = 0;
  for (Index i = 0; i < around; ++i) {
    const Index next = (i + 1) % around;
    star.triangles.col(t++) << south, next, i;
    for (Index low = 0; low + around < south; low += around) {
      star.triangles.col(t++) << low + i, low + next, low + around + next;
      star.triangles.col(t++) << low + i, low + around + next, low + around + i;
    }
    star.triangles.col(t++) << north, south - around + i, south - around + next;
  }
  return star;
}

/// The Stanford bunny, closed and about 1.5 m high. Throws InputError if it is not installed.
inline TriangleMesh bunny() {
  const PolygonMesh mesh = read_obj(std::filesystem::path(SPRUNG_TEST_MESHES) / "bunny.obj");
  return {mesh.vertices, triangulate(mesh.faces)};
}

/// A point `distance` [m] away from a random point of the mesh, in a random direction.
inline Vector3 near_surface(const TriangleMesh& mesh, Random& random, double distance) {
  const auto corner = mesh.triangles.col(random.below(static_cast<Index>(mesh.triangles.cols())));
  const double u = random.between(0.0, 1.0);
  const double v = random.between(0.0, 1.0 - u);
  const Vector3 point =
      (1.0 - u - v) * mesh.vertices.col(corner[0]) + u * mesh.vertices.col(corner[1]) + v * mesh.vertices.col(corner[2]);
  return point + distance * random.direction();
}

/// Distance [m] between a point and a triangle in extended precision: the height above the plane if the foot is inside, else the
/// distance from the nearest edge. Shares no formula with the code under test.
inline double brute_distance(const TriangleMesh& mesh, Index triangle, const Vector3& point) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  const Long3 p = point.cast<long double>();
  Long3 x[3];
  for (int k = 0; k < 3; ++k) x[k] = mesh.vertices.col(mesh.triangles(k, triangle)).cast<long double>();
  long double best = std::numeric_limits<long double>::infinity();
  const Long3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  bool inside = normal.squaredNorm() > 0;
  for (int k = 0; k < 3; ++k) {
    const Long3 from = x[k];
    const Long3 along = x[(k + 1) % 3] - from;
    const long double length2 = along.squaredNorm();
    const long double t = length2 > 0 ? std::min(1.0L, std::max(0.0L, along.dot(p - from) / length2)) : 0.0L;
    best = std::min(best, (p - from - t * along).norm());
    inside = inside && normal.cross(along).dot(p - from) >= 0;
  }
  if (inside) best = std::min(best, std::abs(normal.dot(p - x[0])) / normal.norm());
  return static_cast<double>(best);
}

inline double brute_distance(const TriangleMesh& mesh, const Vector3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < mesh.triangles.cols(); ++t) best = std::min(best, brute_distance(mesh, t, p));
  return best;
}

/// Winding number of the mesh around p (van Oosterom and Strackee 1983): 1 inside a closed mesh, 0 outside.
inline double winding_number(const TriangleMesh& mesh, const Vector3& p) {
  double angle = 0.0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3 a = mesh.vertices.col(mesh.triangles(0, t)) - p;
    const Vector3 b = mesh.vertices.col(mesh.triangles(1, t)) - p;
    const Vector3 c = mesh.vertices.col(mesh.triangles(2, t)) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace sprung::test
