#include "geometry/queries/closest_point_simd.h"
#include "geometry/queries/closest_pair.h"
#include "geometry/queries/segment_pair_simd.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace sprung {
namespace {

class RandomPoints {
 public:
  Vector3 operator()(double size = 1.0) { return size * Vector3(number_(engine_), number_(engine_), number_(engine_)); }
  unsigned below(unsigned count) { return static_cast<unsigned>(engine_() % count); }

 private:
  std::mt19937_64 engine_{11};
  std::uniform_real_distribution<double> number_{-1.0, 1.0};
};

TEST(Double4, LanesOfAMaskArePoppedFromTheLowest) {
  const Double4 numbers{3.0, -1.0, 5.0, -2.0};
  const Mask4 below = numbers < 4.0;
  unsigned lanes = mask_bits(below);
  EXPECT_EQ(lanes, 0b1011U);
  EXPECT_EQ(pop_lane(lanes), 0);
  EXPECT_EQ(pop_smallest_lane(numbers, lanes), 3);
  EXPECT_EQ(pop_smallest_lane(numbers, lanes), 1);
  EXPECT_EQ(lanes, 0U);
}

TEST(ClosestPointLanes, EqualThoseOfEachTriangleToTheLastBit) {
  RandomPoints random;
  std::array<int, 7> counts{};
  for (int i = 0; i < 10000; ++i) {
    std::array<std::array<Vector3, 4>, kSimdWidth> points;
    Vector3x4 p;
    TriangleLanes triangles;
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      auto& [q, a, b, c] = points[static_cast<std::size_t>(lane)];
      a = random();
      b = random();
      c = random.below(5) == 0 ? Vector3(a + 0.4 * (b - a) + random(std::pow(10.0, -1.0 - random.below(17)))) : random();
      q = random.below(3) == 0 ? Vector3((a + b + c) / 3.0 + random(0.1)) : random(2.0);
      set_lane(lane, q, p);
      set_lane(lane, a, triangles.a);
      set_lane(lane, b, triangles.b);
      set_lane(lane, c, triangles.c);
    }
    ClosestPointLanes closest;
    const unsigned needles = closest_points(p, triangles, closest);
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      if ((needles >> lane & 1U) != 0) continue;
      const auto& [q, a, b, c] = points[static_cast<std::size_t>(lane)];
      const ClosestPoint alone = closest_point_on_triangle(q, a, b, c);
      const Vector3 point(closest.point.x[lane], closest.point.y[lane], closest.point.z[lane]);
      ASSERT_EQ(point, alone.point);
      ASSERT_EQ(closest.squared_distance[lane], alone.squared_distance);
      // Three coordinates of at most 2, times weights, each rounded a few times.
      const Vector3 sum = closest.of_a[lane] * a + closest.of_b[lane] * b + closest.of_c[lane] * c;
      ASSERT_LT((sum - point).norm(), 1e-14);
      const Vector3 weights(closest.of_a[lane], closest.of_b[lane], closest.of_c[lane]);
      ASSERT_GE(weights.minCoeff(), 0.0);
      ASSERT_NEAR(weights.sum(), 1.0, 1e-15);
      const auto feature = static_cast<std::size_t>(alone.feature);
      const Index corners_off = feature < 3 ? 2 : feature < 6 ? 1 : 0;
      ASSERT_GE((weights.array() == 0.0).count(), corners_off) << "a corner that does not contribute has a weight";
      ++counts[feature];
    }
  }
  for (const int count : counts) EXPECT_GT(count, 1000);
}

TEST(SegmentPairLanes, EqualThoseOfEachPairToTheLastBit) {
  RandomPoints random;
  int without_length = 0;
  for (int i = 0; i < 10000; ++i) {
    std::array<std::array<Vector3, 4>, kSimdWidth> points;
    SegmentLanes first;
    SegmentLanes second;
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      auto& [a0, a1, b0, b1] = points[static_cast<std::size_t>(lane)];
      a0 = random();
      a1 = random.below(20) == 0 ? a0 : random();
      b0 = random(2.0);
      b1 = random.below(5) == 0 ? Vector3(b0 + a1 - a0) : random();  // some are parallel
      set_lane(lane, a0, first.from);
      set_lane(lane, a1, first.to);
      set_lane(lane, b0, second.from);
      set_lane(lane, b1, second.to);
    }
    SegmentPairLanes pairs;
    const unsigned points_among_them = closest_points(first, second, pairs);
    for (int lane = 0; lane < kSimdWidth; ++lane) {
      const auto& [a0, a1, b0, b1] = points[static_cast<std::size_t>(lane)];
      const bool point = a0 == a1 || b0 == b1;
      ASSERT_EQ((points_among_them >> lane & 1U) != 0, point);
      without_length += point ? 1 : 0;
      if (point) continue;
      const SegmentPair alone = closest_points_of_segments(a0, a1, b0, b1);
      ASSERT_EQ(pairs.s[lane], alone.s);
      ASSERT_EQ(pairs.t[lane], alone.t);
      ASSERT_EQ(pairs.squared_distance[lane], alone.squared_distance);
    }
  }
  EXPECT_GT(without_length, 1000);
}

}  // namespace
}  // namespace sprung
