#include "base/error.h"
#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using test::Random;

std::unique_ptr<ObstacleShape> shape_of(const TriangleMesh& mesh, bool closed) {
  return make_shape(MeshGeometry{std::make_shared<const TriangleMesh>(mesh), closed});
}

/// Compares the nearest surface point with a search over all triangles.
void expect_nearest_is_nearest(const TriangleMesh& mesh, bool closed, int points, double reach) {
  const auto shape = shape_of(mesh, closed);
  const Box3 box = bounds(mesh.vertices);
  const double size = box.sizes().maxCoeff();
  Random random(7);
  for (int i = 0; i < points; ++i) {
    const Vector3 p = i % 2 == 0 ? random.in_box({box.min() * 1.5, box.max() * 1.5})
                                 : test::near_surface(mesh, random, reach * random.between(0, 1));
    const double expected = test::brute_distance(mesh, p);
    const auto found = shape->nearest(p, 10.0 * size);
    ASSERT_TRUE(found);
    // Rounding is a few eps times the size of the coordinates, and more for needles.
    ASSERT_NEAR(std::abs(found->distance), expected, 1e-13 * size) << "point " << i;
    ASSERT_NEAR((p - found->point).norm(), expected, 1e-13 * size);
    ASSERT_NEAR(found->normal.norm(), 1.0, 1e-12);
    ASSERT_NEAR(found->normal.dot(p - found->point), found->distance, 1e-12 * size);
    ASSERT_FALSE(shape->nearest(p, expected * (1.0 - 1e-9) - 1e-13 * size));
    if (expected > 1e-9 * size) {
      ASSERT_TRUE(shape->nearest(p, expected * (1.0 + 1e-9)));
    }
  }
}

TEST(MeshShape, NearestPointIsTheNearestOfAllTriangles) {
  expect_nearest_is_nearest(test::torus(1.0, 0.3, 40, 20), true, 400, 0.01);
  expect_nearest_is_nearest(test::needles(24), true, 400, 0.05);
  expect_nearest_is_nearest(test::terrain(16, [](Index i, Index j) { return 0.3 * std::sin(i) * std::cos(2 * j); }), false, 400,
                            0.1);
}

TEST(MeshShape, ASingleTriangleIsAMesh) {
  TriangleMesh mesh{Points(3, 3), Triangles(3, 1)};
  mesh.vertices << 0, 1, 0, 0, 0, 0, 0, 0, 1;
  mesh.triangles << 0, 1, 2;
  expect_nearest_is_nearest(mesh, false, 100, 0.5);
}

TEST(MeshShape, NearestPointOnTheBunnyIsTheNearestOfAllTriangles) { expect_nearest_is_nearest(test::bunny(), true, 40, 0.01); }

void expect_signs_by_winding_number(const TriangleMesh& mesh, int points, double reach) {
  const auto shape = shape_of(mesh, true);
  const Box3 box = bounds(mesh.vertices);
  Random random(11);
  for (int i = 0; i < points; ++i) {
    const Vector3 p = i % 4 == 0 ? random.in_box(box) : test::near_surface(mesh, random, reach * random.between(0.001, 1));
    const bool inside = test::winding_number(mesh, p) > 0.5;
    ASSERT_EQ(shape->contains(p), inside) << "point " << i;
    ASSERT_EQ(shape->nearest(p, 100.0)->distance < 0.0, inside);
  }
}

TEST(MeshShape, SignFollowsTheWindingNumber) {
  expect_signs_by_winding_number(test::torus(1.0, 0.3, 40, 20), 2000, 0.05);
  expect_signs_by_winding_number(test::needles(24), 4000, 0.05);
}

TEST(MeshShape, SignOnTheBunnyFollowsTheWindingNumber) { expect_signs_by_winding_number(test::bunny(), 200, 0.01); }

TEST(MeshShape, OpenMeshHasNoInsideAndFacesTheParticle) {
  const auto shape = shape_of(test::flat_sheet(4), false);
  const auto above = shape->nearest(Vector3(0.3, 0.2, 0.4), 1.0);
  const auto below = shape->nearest(Vector3(0.3, -0.2, 0.4), 1.0);
  ASSERT_TRUE(above && below);
  EXPECT_EQ(above->normal, Vector3::UnitY());
  EXPECT_EQ(below->normal, -Vector3::UnitY());
  EXPECT_EQ(above->distance, 0.2);
  EXPECT_EQ(below->distance, 0.2);
  EXPECT_FALSE(shape->contains(Vector3(0.3, -0.2, 0.4)));
}

TEST(MeshShape, OpenMeshFacesTheParticleAtTheSmallestHeight) {
  const auto shape = shape_of(test::flat_sheet(4), false);
  const double height = std::numeric_limits<double>::min();
  EXPECT_EQ(shape->nearest(Vector3(0.3, height, 0.4), 1.0)->normal, Vector3::UnitY());
  EXPECT_EQ(shape->nearest(Vector3(0.3, -height, 0.4), 1.0)->normal, -Vector3::UnitY());
}

TEST(MeshShape, ScalingByAPowerOfTwoScalesEveryBit) {
  const TriangleMesh mesh = test::needles(16);
  TriangleMesh large = mesh;
  large.vertices *= 128.0;
  const auto shape = shape_of(mesh, true);
  const auto large_shape = shape_of(large, true);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vector3 p = test::near_surface(mesh, random, 0.02);
    const Vector3 q = test::near_surface(mesh, random, 0.02);
    const auto found = shape->nearest(p, 1.0);
    const auto large_found = large_shape->nearest(128.0 * p, 128.0);
    ASSERT_EQ(128.0 * found->point, large_found->point);
    ASSERT_EQ(128.0 * found->distance, large_found->distance);
    ASSERT_EQ(found->normal, large_found->normal);
    const auto crossing = shape->first_crossing(p, q);
    const auto large_crossing = large_shape->first_crossing(128.0 * p, 128.0 * q);
    ASSERT_EQ(crossing.has_value(), large_crossing.has_value());
    if (crossing) {
      ASSERT_EQ(crossing->fraction, large_crossing->fraction);
    }
  }
}

TEST(MeshShape, DeepTreesAreSearchedCompletely) {
  // Each triangle doubles size and position, so FCL's tree is as deep as the number of triangles.
  constexpr Index kCount = 400;
  TriangleMesh mesh{Points(3, 3 * kCount), Triangles(3, kCount)};
  for (Index t = 0; t < kCount; ++t) {
    const double size = std::ldexp(1.0, t / 4 - 60);
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.col(3 * t + k) = size * (Vector3(1.0 + 0.1 * (t % 4), 0.0, 0.0) + 0.05 * Vector3::Unit(k));
      mesh.triangles(k, t) = 3 * t + k;
    }
  }
  const auto shape = shape_of(mesh, false);
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Index t = random.below(kCount);
    const Vector3 p = mesh.vertices.col(3 * t) * 1.001;
    EXPECT_NEAR(shape->nearest(p, 1e10)->distance, test::brute_distance(mesh, p), 1e-13 * p.norm());
  }
}

std::vector<std::string> rules_broken_by(const MeshGeometry& geometry) {
  std::vector<std::string> keys;
  try {
    (void)make_shape(geometry);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) keys.push_back(problem.key + ": " + problem.rule);
  }
  return keys;
}

TEST(MeshShape, InvalidMeshesAreRefused) {
  TriangleMesh mesh = test::flat_sheet(1);
  mesh.vertices(1, 2) = std::numeric_limits<double>::quiet_NaN();
  mesh.triangles(0, 0) = 4;
  mesh.triangles(1, 1) = -1;
  EXPECT_THAT(rules_broken_by({std::make_shared<const TriangleMesh>(mesh), false}),
              testing::ElementsAre("mesh: vertex 2: must be finite", "mesh: triangle 0: must use vertices from 0 to 3",
                                   "mesh: triangle 1: must use vertices from 0 to 3"));
  EXPECT_THAT(rules_broken_by({std::make_shared<const TriangleMesh>(), false}), testing::ElementsAre("mesh: must have triangles"));
  EXPECT_THAT(rules_broken_by({}), testing::ElementsAre("mesh: must be given"));
}

// Touching points have no direction between them. The region keeps its closest points and their triangle.
TEST(MeshShape, ATouchingElementKeepsItsClosestPoints) {
  TriangleMesh mesh{Points(3, 6), Triangles(3, 2)};
  mesh.vertices << 0, 1, 0, 2, 3, 2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1;
  mesh.triangles << 0, 3, 1, 4, 2, 5;
  const auto shape = shape_of(mesh, false);
  SafeRegion region;
  shape->find_region({.x = {Vector3(0.2, 0.5, 0.3)}, .count = 1}, {.reach = 1.0, .gap = 0.1, .exact = 1.0}, region);
  const Vector3 point = region.point;
  ASSERT_EQ(region.triangle, 0);
  shape->update_closest_points({.x = {Vector3(2.2, 0.0, 0.3)}, .count = 1}, {.reach = 1.0, .gap = 0.1, .exact = 1.0}, false,
                               region);
  EXPECT_EQ(region.triangle, 0);
  EXPECT_EQ(region.point, point);
}

}  // namespace
}  // namespace sprung
