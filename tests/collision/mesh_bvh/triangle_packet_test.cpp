#include "collision/mesh_bvh/triangle_packet.h"

#include "collision/mesh_bvh/triangle_packet_distance.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

using test::Random;

using Corners = std::array<Vector3, 3>;

TrianglePacket block_of(const std::array<Corners, kSimdWidth>& triangles) {
  TrianglePacket block{};
  block.count = kSimdWidth;
  for (int lane = 0; lane < kSimdWidth; ++lane) {
    block.triangle[lane] = lane;
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) block.corner[k][axis][lane] = triangles[lane][k][axis];
    }
  }
  return block;
}

Vector3 anywhere(Random& random, double size) { return random.in_box({Vector3::Constant(-size), Vector3::Constant(size)}); }

/// From sound triangles to needles thinner than rounding, segments and points.
Corners some_triangle(Random& random) {
  const Vector3 a = anywhere(random, 1.0);
  const Vector3 b = anywhere(random, 1.0);
  switch (random.below(6)) {
    case 0:
      return {a, a + 0.6 * (b - a) + anywhere(random, std::pow(10.0, -random.between(1.0, 18.0))), b};
    case 1:
      return {a, b, b};
    case 2:
      return {a, a, a};
    default:
      return {a, b, anywhere(random, 1.0)};
  }
}

TEST(TrianglePacket, DistancesAreThoseOfEachTriangleToTheLastBit) {
  Random random(2);
  std::array<int, 7> met{};
  for (int i = 0; i < 20000; ++i) {
    std::array<Corners, kSimdWidth> triangles;
    for (Corners& triangle : triangles) triangle = some_triangle(random);
    const TrianglePacket block = block_of(triangles);
    // A third of the positions is above the inside of a triangle, a few are on a corner.
    Vector3 p = anywhere(random, 2.0);
    if (i % 3 == 0) p = (triangles[0][0] + triangles[0][1] + triangles[0][2]) / 3.0 + anywhere(random, 0.1);
    if (i % 50 == 0) p = triangles[0][random.below(3)];
    Double4 squared;
    squared_distances(p, block, squared);
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      const auto& [a, b, c] = triangles[lane];
      const ClosestPoint alone = closest_point_on_triangle(p, a, b, c);
      ASSERT_EQ(squared[lane], alone.squared_distance) << "block " << i << ", lane " << lane;
      ++met[static_cast<std::size_t>(alone.feature)];
    }
  }
  for (const int times : met) EXPECT_GT(times, 1000);
}

TEST(TrianglePacket, TrianglesInABoxAreThoseWhoseOwnBoxMeetsIt) {
  Random random(3);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    std::array<Corners, kSimdWidth> triangles;
    for (Corners& triangle : triangles) triangle = some_triangle(random);
    TrianglePacket block = block_of(triangles);
    block.count = 1 + random.below(kSimdWidth);
    Box3 box(anywhere(random, 1.0));
    // Half of the boxes touch a corner of a triangle, no more.
    box.extend(i % 2 == 0 ? triangles[0][0] : anywhere(random, 1.0));
    const unsigned inside = triangles_in_box(block, box);
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      Box3 own;
      for (const Vector3& corner : block.corners(lane)) own.extend(corner);
      const bool expected = lane < block.count && own.intersects(box);
      ASSERT_EQ((inside >> lane & 1U) != 0, expected);
      found += expected ? 1 : 0;
    }
  }
  EXPECT_GT(found, 2500);
}

TEST(TrianglePacket, TrianglesAboveAPlaneAreThoseWithACornerThere) {
  Random random(4);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    std::array<Corners, kSimdWidth> triangles;
    for (Corners& triangle : triangles) triangle = some_triangle(random);
    TrianglePacket block = block_of(triangles);
    block.count = 1 + random.below(kSimdWidth);
    const Vector3 normal = random.direction();
    const double limit = random.between(-1.0, 1.0);
    const unsigned above = triangles_above(block, normal, limit);
    for (int lane = 0; lane < block.count; ++lane) {
      const auto& [a, b, c] = triangles[lane];
      const double highest = std::max({normal.dot(a), normal.dot(b), normal.dot(c)});
      if (std::abs(highest - limit) < 1e-15) continue;  // three products below 1, rounded
      ASSERT_EQ((above >> lane & 1U) != 0, highest > limit);
      found += highest > limit ? 1 : 0;
    }
    ASSERT_EQ(above >> block.count, 0U);
  }
  EXPECT_GT(found, 2500);
}

}  // namespace
}  // namespace sprung
