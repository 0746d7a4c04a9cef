#include "collision/safe_regions/mesh_safe_region.h"

#include "collision/safe_regions/safe_region_builder.h"
#include "sample_meshes.h"
#include "zone_trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

using test::crosses;
using test::holds;
using test::moved_within;
using test::Random;
using test::random_element;

/// The law of zones, for elements of `size` at up to `height` from the mesh.
void expect_no_crossing(const TriangleMesh& mesh, double size, double height, int trials) {
  const MeshTree tree(mesh);
  const auto triangles = static_cast<Index>(mesh.triangles.cols());
  Random random(3);
  int zones = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const ElementCorners element = random_element(mesh, random, 1 + trial % 3, size, height);
    const ZoneRequest request{
        .reach = random.between(0.2, 2.0) * size, .gap = random.between(0.0, 0.5) * size, .clearance = 1e-9, .exact = size};
    Zone zone;
    zone.triangle = trial % 2 == 0 ? kNone : random.below(triangles);
    find_zone(tree, element, request, zone);
    ASSERT_EQ(zone.broken, crosses(element, mesh)) << "trial " << trial;
    if (zone.broken) continue;
    ++zones;
    for (int i = 0; i < element.count; ++i) {
      const Vector3& corner = element.x[static_cast<std::size_t>(i)];
      ASSERT_TRUE(holds(zone, corner, corner)) << "trial " << trial;
    }
    for (int move = 0; move < 8; ++move) {
      ElementCorners moved = element;
      for (int i = 0; i < element.count; ++i) {
        auto& corner = moved.x[static_cast<std::size_t>(i)];
        corner = moved_within(zone, corner, request.reach, random);
      }
      ASSERT_FALSE(crosses(moved, mesh)) << "trial " << trial << " with " << zone.plane_count << " planes";
    }
  }
  EXPECT_GT(zones, trials / 5);
}

TEST(MeshZone, NothingCrossesWhileCornersStayInside) {
  expect_no_crossing(test::torus(1.0, 0.4, 24, 12), 0.3, 0.3, 600);
  expect_no_crossing(test::needles(12), 0.3, 0.5, 600);
  expect_no_crossing(test::terrain(8, [](Index i, Index j) { return 0.7 * ((i * 7 + j * 3) % 4); }), 0.6, 1.0, 600);
}

TEST(MeshZone, NothingCrossesOnTheBunny) { expect_no_crossing(test::bunny(), 0.02, 0.02, 150); }

// In a valley of facets that turn by a hundredth most triangles have no plane of their own.
TEST(MeshZone, EachTriangleInTheBoxIsBehindAPlane) {
  constexpr double kTurn = 0.01;
  TriangleMesh valley = test::flat_sheet(60);
  for (Index i = 0; i < valley.vertices.cols(); ++i) {
    const Vector3 p = valley.vertices.col(i);
    valley.vertices.col(i) = Vector3(std::sin(kTurn * p.x()), -std::cos(kTurn * p.x()), kTurn * p.z());
  }
  const MeshTree tree(valley);
  Random random(7);
  int behind = 0;
  int planes = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const ElementCorners element = random_element(valley, random, 3, 0.05, 0.03);
    Zone zone;
    find_zone(tree, element, {.reach = 0.05, .gap = 0.03, .clearance = 1e-9, .exact = 0.05}, zone);
    if (zone.broken || std::isfinite(zone.free_radius)) continue;
    planes += zone.plane_count;
    for (Index t = 0; t < valley.triangles.cols(); ++t) {
      const auto corners = tree.corners(t);
      Box3 box(corners[0]);
      box.extend(corners[1]).extend(corners[2]);
      if (!box.intersects(zone.box)) continue;
      ++behind;
      EXPECT_TRUE(std::any_of(zone.planes.begin(), zone.planes.begin() + zone.plane_count,
                              [&](const HalfSpace& plane) { return highest_along(plane.normal, corners) < plane.offset; }))
          << "trial " << trial << " triangle " << t;
    }
  }
  EXPECT_GT(behind, 20 * planes);
}

TEST(MeshZone, NearestPairIsTheNearestOfAll) {
  const TriangleMesh mesh = test::needles(12);
  const MeshTree tree(mesh);
  Random random(5);
  int compared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const ElementCorners element = random_element(mesh, random, 3, 0.2, 0.4);
    Zone zone;
    find_zone(tree, element, {.reach = 0.3, .gap = 0.05, .clearance = 1e-9, .exact = 0.2}, zone);
    if (zone.broken) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      nearest = std::min(nearest, std::sqrt(closest_pair(element, tree.corners(t)).squared_distance));
    }
    EXPECT_LE(zone.clear, nearest);
    if (zone.distance >= 0.2) continue;
    ++compared;
    // A neighbour that shares the nearest point is not looked at to find it nearer by rounding: 2^-30 of the distance.
    EXPECT_NEAR(zone.distance, nearest, 0x1p-30 * nearest);
    const Vector3 on_element = zone.weights[0] * element.x[0] + zone.weights[1] * element.x[1] + zone.weights[2] * element.x[2];
    EXPECT_NEAR((zone.point + zone.distance * zone.normal - on_element).norm(), 0.0, 1e-14);
  }
  EXPECT_GT(compared, 100);
}

TEST(MeshZone, WhatIsClearIsNoMoreThanTheDistance) {
  const TriangleMesh mesh = test::needles(12);
  const MeshTree tree(mesh);
  Random random(6);
  int far = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const ElementCorners element = random_element(mesh, random, 3, 0.2, 3.0);
    Zone zone;
    find_zone(tree, element, {.reach = 0.1, .gap = 0.05, .clearance = 1e-9, .exact = 0.1}, zone);
    if (zone.broken || zone.triangle != kNone) continue;
    ++far;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      nearest = std::min(nearest, std::sqrt(closest_pair(element, tree.corners(t)).squared_distance));
    }
    EXPECT_LE(zone.clear, nearest);
    EXPECT_FALSE(zone.box.isEmpty());
  }
  EXPECT_GT(far, 100);
}

TEST(MeshZone, FarElementIsFreeInAllOfItsBoxAndMoreWhereTheMeshIsFarther) {
  const MeshTree tree(test::torus(1.0, 0.4, 24, 12));
  const ElementCorners element{.x = {Vector3(5, 0, 0), Vector3(5, 1, 0), Vector3(5, 0, 1)}, .count = 3};
  Zone zone;
  find_zone(tree, element, {.reach = 0.5, .gap = 0.1, .clearance = 1e-9, .exact = 0.2}, zone);
  EXPECT_EQ(zone.plane_count, 0);
  EXPECT_EQ(zone.distance, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(zone.box.contains(Box3(Vector3(4.5, -0.5, -0.5), Vector3(5.5, 1.5, 1.5))));
  // The torus begins 3.6 from the element.
  EXPECT_GT(zone.clear, 0.5 * std::sqrt(3.0));
  EXPECT_LT(zone.clear, 3.6);
  EXPECT_LE((zone.box.max() - Vector3(5, 1, 1)).norm(), zone.clear);
}

}  // namespace
}  // namespace sprung
