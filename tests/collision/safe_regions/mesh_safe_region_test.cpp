#include "collision/safe_regions/mesh_safe_region.h"

#include "collision/safe_region_trials.h"
#include "collision/safe_regions/safe_region_builder.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

using test::contains;
using test::crosses;
using test::moved_within;
using test::Random;
using test::random_element;

/// Checks that no element crosses the mesh while its corners stay in its safe region. Elements of `size` [m], up to `height` [m]
/// from the mesh.
void expect_no_crossing(const TriangleMesh& mesh, double size, double height, int trials) {
  const MeshBvh tree(mesh);
  const auto triangles = static_cast<Index>(mesh.triangles.cols());
  Random random(3);
  int regions = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const ElementCorners element = random_element(mesh, random, 1 + trial % 3, size, height);
    const SafeRegionRequest request{
        .reach = random.between(0.2, 2.0) * size, .gap = random.between(0.0, 0.5) * size, .clearance = 1e-9, .exact = size};
    SafeRegion region;
    region.triangle = trial % 2 == 0 ? kNone : random.below(triangles);
    find_region(tree, element, request, region);
    ASSERT_EQ(region.broken, crosses(element, mesh)) << "trial " << trial;
    if (region.broken) continue;
    ++regions;
    for (int i = 0; i < element.count; ++i) {
      const Vector3& corner = element.x[static_cast<std::size_t>(i)];
      ASSERT_TRUE(contains(region, corner, corner)) << "trial " << trial;
    }
    for (int move = 0; move < 8; ++move) {
      ElementCorners moved = element;
      for (int i = 0; i < element.count; ++i) {
        auto& corner = moved.x[static_cast<std::size_t>(i)];
        corner = moved_within(region, corner, request.reach, random);
      }
      ASSERT_FALSE(crosses(moved, mesh)) << "trial " << trial << " with " << region.plane_count << " planes";
    }
  }
  EXPECT_GT(regions, trials / 5);
}

TEST(MeshSafeRegion, NoElementCrossesWhileItsCornersStayInside) {
  expect_no_crossing(test::torus(1.0, 0.4, 24, 12), 0.3, 0.3, 600);
  expect_no_crossing(test::needles(12), 0.3, 0.5, 600);
  expect_no_crossing(test::terrain(8, [](Index i, Index j) { return 0.7 * ((i * 7 + j * 3) % 4); }), 0.6, 1.0, 600);
}

TEST(MeshSafeRegion, NoElementCrossesTheBunny) { expect_no_crossing(test::bunny(), 0.02, 0.02, 150); }

// In a valley with 0.01 rad between neighbouring facets, most triangles have no plane of their own.
TEST(MeshSafeRegion, EachTriangleInTheBoxIsBehindAPlane) {
  constexpr double kAngle = 0.01;
  TriangleMesh valley = test::flat_sheet(60);
  for (Index i = 0; i < valley.vertices.cols(); ++i) {
    const Vector3 p = valley.vertices.col(i);
    valley.vertices.col(i) = Vector3(std::sin(kAngle * p.x()), -std::cos(kAngle * p.x()), kAngle * p.z());
  }
  const MeshBvh tree(valley);
  Random random(7);
  int behind = 0;
  int planes = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const ElementCorners element = random_element(valley, random, 3, 0.05, 0.03);
    SafeRegion region;
    find_region(tree, element, {.reach = 0.05, .gap = 0.03, .clearance = 1e-9, .exact = 0.05}, region);
    if (region.broken || std::isfinite(region.free_radius)) continue;
    planes += region.plane_count;
    for (Index t = 0; t < valley.triangles.cols(); ++t) {
      const auto corners = tree.corners(t);
      Box3 box(corners[0]);
      box.extend(corners[1]).extend(corners[2]);
      if (!box.intersects(region.box)) continue;
      ++behind;
      EXPECT_TRUE(std::any_of(region.planes.begin(), region.planes.begin() + region.plane_count,
                              [&](const HalfSpace& plane) { return highest_along(plane.normal, corners) < plane.offset; }))
          << "trial " << trial << " triangle " << t;
    }
  }
  EXPECT_GT(behind, 20 * planes);
}

TEST(MeshSafeRegion, ClosestPointsAreTheClosestOfAllTriangles) {
  const TriangleMesh mesh = test::needles(12);
  const MeshBvh tree(mesh);
  Random random(5);
  int compared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const ElementCorners element = random_element(mesh, random, 3, 0.2, 0.4);
    SafeRegion region;
    find_region(tree, element, {.reach = 0.3, .gap = 0.05, .clearance = 1e-9, .exact = 0.2}, region);
    if (region.broken) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      nearest = std::min(nearest, std::sqrt(closest_pair(element, tree.corners(t)).squared_distance));
    }
    EXPECT_LE(region.clear, nearest);
    if (region.distance >= 0.2) continue;
    ++compared;
    // A triangle that shares the closest point is skipped unless it is nearer by 2^-30 of the distance.
    EXPECT_NEAR(region.distance, nearest, 0x1p-30 * nearest);
    const Vector3 on_element =
        region.weights[0] * element.x[0] + region.weights[1] * element.x[1] + region.weights[2] * element.x[2];
    EXPECT_NEAR((region.point + region.distance * region.normal - on_element).norm(), 0.0, 1e-14);
  }
  EXPECT_GT(compared, 100);
}

TEST(MeshSafeRegion, ClearDistanceIsAtMostTheDistance) {
  const TriangleMesh mesh = test::needles(12);
  const MeshBvh tree(mesh);
  Random random(6);
  int far = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const ElementCorners element = random_element(mesh, random, 3, 0.2, 3.0);
    SafeRegion region;
    find_region(tree, element, {.reach = 0.1, .gap = 0.05, .clearance = 1e-9, .exact = 0.1}, region);
    if (region.broken || region.triangle != kNone) continue;
    ++far;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      nearest = std::min(nearest, std::sqrt(closest_pair(element, tree.corners(t)).squared_distance));
    }
    EXPECT_LE(region.clear, nearest);
    EXPECT_FALSE(region.box.isEmpty());
  }
  EXPECT_GT(far, 100);
}

TEST(MeshSafeRegion, AFarElementHasMoreThanTheRequestedBox) {
  const MeshBvh tree(test::torus(1.0, 0.4, 24, 12));
  const ElementCorners element{.x = {Vector3(5, 0, 0), Vector3(5, 1, 0), Vector3(5, 0, 1)}, .count = 3};
  SafeRegion region;
  find_region(tree, element, {.reach = 0.5, .gap = 0.1, .clearance = 1e-9, .exact = 0.2}, region);
  EXPECT_EQ(region.plane_count, 0);
  EXPECT_EQ(region.distance, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(region.box.contains(Box3(Vector3(4.5, -0.5, -0.5), Vector3(5.5, 1.5, 1.5))));
  // The torus is 3.6 m away from the element.
  EXPECT_GT(region.clear, 0.5 * std::sqrt(3.0));
  EXPECT_LT(region.clear, 3.6);
  EXPECT_LE((region.box.max() - Vector3(5, 1, 1)).norm(), region.clear);
}

}  // namespace
}  // namespace sprung
