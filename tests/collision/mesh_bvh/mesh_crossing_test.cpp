// First crossings of straight paths with meshes on an integer grid, where paths hit edges and vertices exactly; checked in
// integers.
#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace sprung {
namespace {

using test::Random;
using Grid = Eigen::Matrix<std::int64_t, 3, 1>;

Grid on_grid(const Vector3& p) { return p.array().round().matrix().cast<std::int64_t>(); }

/// A fraction of a path: a quotient of integers, under > 0.
struct Quotient {
  std::int64_t over;
  std::int64_t under;
  Index triangle = kNone;
};
bool operator<(const Quotient& x, const Quotient& y) { return x.over * y.under < y.over * x.under; }

/// The crossing of the path with the triangle, if any: the point on the triangle's plane as a rational, then its side of each edge.
/// With coordinates below 64 all products stay below 2^62.
std::optional<Quotient> grid_crossing(const TriangleMesh& mesh, Index t, const Grid& a, const Grid& b, bool closed) {
  Grid x[3];
  for (int k = 0; k < 3; ++k) x[k] = on_grid(mesh.vertices.col(mesh.triangles(k, t)));
  const Grid normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const std::int64_t begin = normal.dot(a - x[0]);
  const std::int64_t end = normal.dot(b - x[0]);
  const bool inward = (begin > 0 && end <= 0) || (closed && begin == 0 && end < 0);
  const bool outward = !closed && begin < 0 && end >= 0;
  if (!inward && !outward) return std::nullopt;
  const std::int64_t over = inward ? begin : -begin;
  const std::int64_t under = inward ? begin - end : end - begin;
  const Grid hit = a * under + (b - a) * over;  // times under
  for (int k = 0; k < 3; ++k) {
    const Grid across = normal.cross(x[(k + 1) % 3] - x[k]);
    if (across.dot(hit - x[k] * under) < 0) return std::nullopt;
  }
  return Quotient{over, under, t};
}

/// The crossing with the smallest fraction; if several have it, the first triangle's.
std::optional<Quotient> first_grid_crossing(const TriangleMesh& mesh, const Grid& a, const Grid& b, bool closed) {
  std::optional<Quotient> first;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto crossing = grid_crossing(mesh, t, a, b, closed);
    if (crossing && (!first || *crossing < *first)) first = crossing;
  }
  return first;
}

std::unique_ptr<ObstacleShape> shape_of(const TriangleMesh& mesh, bool closed) {
  return make_shape(MeshGeometry{std::make_shared<const TriangleMesh>(mesh), closed});
}

TriangleMesh on_grid(TriangleMesh mesh, double scale) {
  mesh.vertices = (scale * mesh.vertices).array().round();
  return mesh;
}

/// Compares with brute force for paths between random grid points, and for paths through vertices and edge midpoints of the mesh.
void expect_every_crossing_found(const TriangleMesh& mesh, bool closed, int paths) {
  const auto shape = shape_of(mesh, closed);
  const Box3 box = bounds(mesh.vertices);
  Random random(13);
  int crossed = 0;
  for (int i = 0; i < paths; ++i) {
    Grid a = on_grid(random.in_box({box.min() - Vector3::Ones() * 4, box.max() + Vector3::Ones() * 4}));
    Grid b = on_grid(random.in_box({box.min() - Vector3::Ones() * 4, box.max() + Vector3::Ones() * 4}));
    if (i % 4 != 0) {
      const auto corner = mesh.triangles.col(random.below(static_cast<Index>(mesh.triangles.cols())));
      const Grid sum = on_grid(mesh.vertices.col(corner[0])) + on_grid(mesh.vertices.col(corner[i % 4 == 1 ? 0 : 1]));
      const Grid through = sum / 2;
      const Grid step = on_grid(3.0 * random.direction());
      a = through - random.below(4) * step;
      b = through + random.below(4) * step;
    }
    const auto expected = first_grid_crossing(mesh, a, b, closed);
    const auto found = shape->first_crossing(a.cast<double>(), b.cast<double>());
    ASSERT_EQ(found.has_value(), expected.has_value()) << "from " << a.transpose() << " to " << b.transpose();
    if (!found) continue;
    ++crossed;
    ASSERT_NEAR(found->fraction, static_cast<double>(expected->over) / static_cast<double>(expected->under), 1e-15);
    const Vector3 face = area_normal(mesh, expected->triangle).normalized();
    const bool from_behind = face.dot((b - a).cast<double>()) > 0.0;
    ASSERT_EQ(found->normal, from_behind ? Vector3(-face) : face);
  }
  EXPECT_GT(crossed, paths / 10);
}

TEST(FirstCrossing, IsFoundForEveryPathThroughAnOpenMesh) {
  expect_every_crossing_found(test::flat_sheet(8), false, 20000);
  expect_every_crossing_found(test::terrain(12, [](Index i, Index j) { return (i * 7 + j * 3) % 5; }), false, 20000);
}

TEST(FirstCrossing, IsFoundForEveryPathIntoAClosedMesh) {
  expect_every_crossing_found(on_grid(test::torus(20.0, 8.0, 12, 8), 1.0), true, 20000);
  expect_every_crossing_found(on_grid(test::needles(12), 40.0), true, 20000);
}

TEST(FirstCrossing, ComesBeforeAnyPointInsideAClosedMesh) {
  const TriangleMesh mesh = test::torus(1.0, 0.3, 60, 30);
  const auto shape = shape_of(mesh, true);
  Random random(17);
  for (int i = 0; i < 20000; ++i) {
    const double angle = random.between(0.0, 7.0);
    const Vector3 inside(std::cos(angle), random.between(-0.1, 0.1), std::sin(angle));
    const Index vertex = random.below(static_cast<Index>(mesh.vertices.cols()));
    // Through a vertex or the midpoint of an edge, as exactly as doubles allow.
    const Vector3 through =
        i % 2 == 0 ? Vector3(mesh.vertices.col(vertex))
                   : Vector3(0.5 * (mesh.vertices.col(mesh.triangles(0, vertex)) + mesh.vertices.col(mesh.triangles(1, vertex))));
    const Vector3 outside = inside + 50.0 * (through - inside);
    const auto crossing = shape->first_crossing(outside, inside);
    ASSERT_TRUE(crossing);
    ASSERT_FALSE(shape->contains(outside + 0.999 * crossing->fraction * (inside - outside)));
  }
}

TEST(FirstCrossing, OfAClosedMeshIgnoresThePathOutOfIt) {
  const auto shape = shape_of(test::torus(1.0, 0.3, 60, 30), true);
  EXPECT_FALSE(shape->first_crossing(Vector3(1, 0, 0), Vector3(1, 5, 0)));
  EXPECT_TRUE(shape->first_crossing(Vector3(1, 5, 0), Vector3(1, 0, 0)));
  // Out of the ring on one side and into it on the other.
  const auto crossing = shape->first_crossing(Vector3(1, 0, 0), Vector3(-1, 0, 0));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->fraction, 0.85, 0.01);
}

TEST(FirstCrossing, OfAnOpenMeshIsFoundFromBothSides) {
  const auto shape = shape_of(test::flat_sheet(4), false);
  const Vector3 above(0.3, 1.0, 0.4);
  const Vector3 below(0.3, -3.0, 0.4);
  const auto down = shape->first_crossing(above, below);
  const auto up = shape->first_crossing(below, above);
  ASSERT_TRUE(down && up);
  EXPECT_EQ(down->fraction, 0.25);
  EXPECT_EQ(up->fraction, 0.75);
  EXPECT_EQ(down->normal, Vector3::UnitY());
  EXPECT_EQ(up->normal, -Vector3::UnitY());
}

TEST(FirstCrossing, CountsPathsThatEndOnTheSurfaceButNotPathsThatBeginOnAnOpenMesh) {
  const auto open = shape_of(test::flat_sheet(4), false);
  const auto closed = shape_of(test::flat_sheet(4), true);
  const Vector3 on(0.3, 0.0, 0.4);
  const Vector3 above(0.3, 1.0, 0.4);
  const Vector3 below(0.3, -1.0, 0.4);
  const Vector3 aside(0.5, 0.0, 0.4);
  EXPECT_EQ(open->first_crossing(above, on)->fraction, 1.0);
  EXPECT_EQ(open->first_crossing(below, on)->fraction, 1.0);
  EXPECT_FALSE(open->first_crossing(on, above));
  EXPECT_FALSE(open->first_crossing(on, below));
  EXPECT_EQ(closed->first_crossing(on, below)->fraction, 0.0);
  EXPECT_FALSE(closed->first_crossing(on, above));
  EXPECT_FALSE(closed->first_crossing(on, aside));
  EXPECT_FALSE(open->first_crossing(above, above));
}

}  // namespace
}  // namespace sprung
