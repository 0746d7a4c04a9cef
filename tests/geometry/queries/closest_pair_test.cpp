#include "geometry/queries/closest_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sprung {
namespace {

using Triangle = std::array<Vector3, 3>;

class RandomSimplices {
 public:
  Vector3 point(double size) { return size * Vector3(number_(engine_), number_(engine_), number_(engine_)); }

  Simplex simplex(int corners, const Vector3& middle, double size) {
    Simplex simplex{.count = corners};
    for (int i = 0; i < corners; ++i) simplex.x[static_cast<std::size_t>(i)] = middle + point(size);
    return simplex;
  }

  Triangle triangle(double size) { return {point(size), point(size), point(size)}; }

 private:
  std::mt19937_64 engine_{7};
  std::uniform_real_distribution<double> number_{-1.0, 1.0};
};

/// The distance by which the plane across the pair separates simplex and triangle. No two of their points are nearer.
double separation(const ClosestPair& pair, const Simplex& simplex, const Triangle& triangle) {
  const Vector3 normal = (pair.on_simplex - pair.on_triangle).normalized();
  double lowest = normal.dot(simplex.x[0]);
  for (int i = 1; i < simplex.count; ++i) lowest = std::min(lowest, normal.dot(simplex.x[static_cast<std::size_t>(i)]));
  return lowest - std::max({normal.dot(triangle[0]), normal.dot(triangle[1]), normal.dot(triangle[2])});
}

Vector3 weighted(const Simplex& simplex, const Vector3& weights) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < simplex.count; ++i) sum += weights[i] * simplex.x[static_cast<std::size_t>(i)];
  return sum;
}

TEST(ClosestPair, PlaneAcrossThePairProvesTheDistance) {
  RandomSimplices random;
  for (int corners = 1; corners <= 3; ++corners) {
    int apart = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      const Triangle triangle = random.triangle(1.0);
      const Simplex simplex = random.simplex(corners, random.point(2.0), 1.0);
      const ClosestPair pair = closest_pair(simplex, triangle);
      const double distance = std::sqrt(pair.squared_distance);
      // Coordinates up to 3: products of up to 9 * 27, rounded to 1e-16, divided by the sine of 1e-7 below which edges count as
      // parallel.
      constexpr double kTolerance = 1e-12;
      EXPECT_NEAR((weighted(simplex, pair.weights) - pair.on_simplex).norm(), 0.0, kTolerance);
      EXPECT_NEAR(pair.weights.sum(), 1.0, kTolerance);
      EXPECT_NEAR((pair.on_simplex - pair.on_triangle).norm(), distance, kTolerance);
      if (separation(pair, simplex, triangle) < 0.0) continue;  // they intersect
      ++apart;
      EXPECT_NEAR(separation(pair, simplex, triangle), distance, 1e-7 * distance + kTolerance) << "trial " << trial;
    }
    EXPECT_GT(apart, 1500);
  }
}

TEST(ClosestPair, SlackBoundsTheErrorOfTheDistance) {
  RandomSimplices random;
  for (int trial = 0; trial < 3000; ++trial) {
    const Triangle triangle = random.triangle(1.0);
    const Simplex simplex = random.simplex(3, random.point(3.0), 1.0);
    const double exact = std::sqrt(closest_pair(simplex, triangle).squared_distance);
    const double quick = std::sqrt(closest_pair(simplex, triangle, 0.1).squared_distance);
    EXPECT_GE(quick, exact);
    if (separation(closest_pair(simplex, triangle), simplex, triangle) <= 0.0) continue;  // they intersect
    EXPECT_LE(quick, exact / 0.9 * (1.0 + 1e-12));
  }
}

std::vector<FeaturePair> feature_pairs_of_triangles() {
  std::vector<FeaturePair> feature_pairs;
  for (std::uint8_t i = 0; i < 3; ++i) {
    feature_pairs.push_back({FeaturePairKind::corner_face, i, 0});
    feature_pairs.push_back({FeaturePairKind::face_corner, 0, i});
    for (std::uint8_t k = 0; k < 3; ++k) feature_pairs.push_back({FeaturePairKind::edges, i, k});
  }
  return feature_pairs;
}

TEST(ClosestPair, EarlierFeaturesDoNotChangeTheDistance) {
  RandomSimplices random;
  const std::vector<FeaturePair> feature_pairs = feature_pairs_of_triangles();
  std::array<int, 4> found{};
  for (int trial = 0; trial < 1000; ++trial) {
    const Triangle triangle = random.triangle(1.0);
    const Simplex simplex = random.simplex(3, random.point(3.0), 1.0);
    const ClosestPair pair = closest_pair(simplex, triangle);
    if (separation(pair, simplex, triangle) <= 0.0) continue;  // they intersect
    ++found[static_cast<std::size_t>(pair.features.kind)];
    for (const FeaturePair& last : feature_pairs) {
      const ClosestPair again = closest_pair(simplex, triangle, 0.0, 0.0, last);
      // The features are accepted if their plane separates by the distance up to 1e-12.
      EXPECT_NEAR(again.squared_distance, pair.squared_distance, 2e-12 * pair.squared_distance);
      EXPECT_NEAR((weighted(simplex, again.weights) - again.on_simplex).norm(), 0.0, 1e-12);
      EXPECT_NEAR((again.on_simplex - again.on_triangle).squaredNorm(), again.squared_distance, 1e-12);
    }
  }
  EXPECT_EQ(found[static_cast<std::size_t>(FeaturePairKind::unknown)], 0);
  for (const auto kind : {FeaturePairKind::corner_face, FeaturePairKind::face_corner, FeaturePairKind::edges}) {
    EXPECT_GT(found[static_cast<std::size_t>(kind)], 50);
  }
}

TEST(ClosestPair, EarlierFeaturesWinAmongEquallyNearOnes) {
  const Triangle below{Vector3(-4, -4, 0), Vector3(4, -4, 0), Vector3(0, 4, 0)};
  const Simplex above{.x = {Vector3(-0.5, 0, 1), Vector3(0.5, 0, 1), Vector3(0, 0.5, 1)}, .count = 3};
  for (std::uint8_t corner = 0; corner < 3; ++corner) {
    const FeaturePair last{FeaturePairKind::corner_face, corner, 0};
    const ClosestPair pair = closest_pair(above, below, 0.0, 0.0, last);
    EXPECT_EQ(pair.features.kind, last.kind);
    EXPECT_EQ(pair.features.of_simplex, corner);
    EXPECT_EQ(pair.weights, Vector3::Unit(corner));
    EXPECT_EQ(pair.squared_distance, 1.0);
  }
}

TEST(ClosestPair, PlaneNeverSeparatesIntersectingTriangles) {
  RandomSimplices random;
  for (int trial = 0; trial < 1000; ++trial) {
    const Triangle triangle = random.triangle(1.0);
    const Vector3 inside = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    const Vector3 through = random.point(1.0);
    const Simplex needle{.x = {Vector3(inside - through), Vector3(inside + through), Vector3(inside + through)}, .count = 3};
    EXPECT_LE(separation(closest_pair(needle, triangle), needle, triangle), 1e-15);
  }
}

TEST(ClosestPair, ParallelSegmentsAndPointsHaveAClosestPair) {
  const Vector3 a(0, 0, 0);
  const Vector3 b(1, 0, 0);
  EXPECT_EQ(closest_points_of_segments(a, b, a + Vector3::UnitY(), b + Vector3::UnitY()).squared_distance, 1.0);
  EXPECT_EQ(closest_points_of_segments(a, a, Vector3(0, 2, 0), Vector3(1, 2, 0)).squared_distance, 4.0);
  EXPECT_EQ(closest_points_of_segments(Vector3(0, 2, 0), Vector3(1, 2, 0), b, b).squared_distance, 4.0);
  EXPECT_EQ(closest_points_of_segments(a, a, b, b).squared_distance, 1.0);
}

}  // namespace
}  // namespace sprung
