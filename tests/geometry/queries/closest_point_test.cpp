#include "geometry/queries/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace sprung {
namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;

/// Distance from a triangle in extended precision: to the foot on its plane if that lies inside, else to the nearest edge.
double long_distance(const Vector3& point, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Long3 p = point.cast<long double>();
  const Long3 x[] = {a.cast<long double>(), b.cast<long double>(), c.cast<long double>()};
  const Long3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  long double best = (p - x[0]).norm();
  bool inside = normal.squaredNorm() > 0;
  for (int k = 0; k < 3; ++k) {
    const Long3 along = x[(k + 1) % 3] - x[k];
    const long double length2 = along.squaredNorm();
    const long double t = length2 > 0 ? std::clamp(along.dot(p - x[k]) / length2, 0.0L, 1.0L) : 0.0L;
    best = std::min(best, (p - x[k] - t * along).norm());
    inside = inside && normal.cross(along).dot(p - x[k]) >= 0;
  }
  if (inside) best = std::abs(normal.dot(p - x[0])) / normal.norm();
  return static_cast<double>(best);
}

class RandomPoints {
 public:
  Vector3 operator()(double size) {
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = size * (2.0 * static_cast<double>(engine_() >> 11) * 0x1p-53 - 1.0);
    return p;
  }

 private:
  std::mt19937_64 engine_{4};
};

TEST(ClosestPoint, EachFeatureIsFound) {
  const Vector3 a(0, 0, 0);
  const Vector3 b(2, 0, 0);
  const Vector3 c(0, 2, 0);
  const auto feature = [&](double x, double y) { return closest_point_on_triangle(Vector3(x, y, 1.0), a, b, c).feature; };
  EXPECT_EQ(feature(-1, -1), TriangleFeature::vertex0);
  EXPECT_EQ(feature(4, 0), TriangleFeature::vertex1);
  EXPECT_EQ(feature(0, 4), TriangleFeature::vertex2);
  EXPECT_EQ(feature(1, -1), TriangleFeature::edge01);
  EXPECT_EQ(feature(2, 2), TriangleFeature::edge12);
  EXPECT_EQ(feature(-1, 1), TriangleFeature::edge20);
  EXPECT_EQ(feature(0.5, 0.5), TriangleFeature::face);
}

TEST(ClosestPoint, HasTheDistanceOfExtendedPrecision) {
  RandomPoints random;
  for (int i = 0; i < 20000; ++i) {
    const Vector3 a = random(1.0);
    const Vector3 b = random(1.0);
    const Vector3 c = random(1.0);
    const Vector3 p = random(2.0);
    const ClosestPoint found = closest_point_on_triangle(p, a, b, c);
    ASSERT_EQ(found.squared_distance, (p - found.point).squaredNorm());
    // The thinnest of these triangles has a sine of 1e-4, which costs four digits of the foot's position. The distance depends on
    // the square of that error.
    ASSERT_NEAR(std::sqrt(found.squared_distance), long_distance(p, a, b, c), 1e-11);
  }
}

TEST(ClosestPoint, HasTheDistanceOfExtendedPrecisionForThinTriangles) {
  RandomPoints random;
  for (int i = 0; i < 60000; ++i) {
    const Vector3 tip = random(1.0);
    const Vector3 end = random(1.0);
    // From a well-shaped triangle down to one thinner than rounding.
    const Vector3 beside = tip + 0.6 * (end - tip) + random(std::pow(10.0, -1.0 - i % 18));
    const Vector3 p = i % 2 == 0 ? random(2.0) : Vector3(tip + 0.3 * (end - tip) + random(1e-3));
    const Vector3 corner[] = {tip, end, beside};
    const int k = i / 18 % 3;
    const Vector3& a = corner[k];
    const Vector3& b = corner[(k + 1) % 3];
    const Vector3& c = corner[(k + 2) % 3];
    const ClosestPoint found = closest_point_on_triangle(p, a, b, c);
    // For a triangle of sine s, rounding moves the foot along it by eps / s, at most 1e-11 before the closest point on the edges is
    // used. The foot stays in the plane, so the distance changes by the square of that over the distance, or by eps / s if it is 0.
    ASSERT_NEAR(std::sqrt(found.squared_distance), long_distance(p, a, b, c), 1e-10) << "triangle " << i;
  }
}

TEST(ClosestPoint, TrianglesWithoutAreaAreSegmentsOrPoints) {
  const Vector3 a(0, 0, 0);
  const Vector3 b(2, 0, 0);
  const Vector3 middle(0.5, 0, 0);
  RandomPoints random;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = random(3.0);
    const double expected = long_distance(p, a, b, a);
    for (const auto& [u, v, w] : {std::array{a, a, b}, {a, b, a}, {b, a, a}, {a, b, middle}, {a, middle, b}, {middle, a, b}}) {
      ASSERT_NEAR(std::sqrt(closest_point_on_triangle(p, u, v, w).squared_distance), expected, 1e-15);
    }
    ASSERT_EQ(closest_point_on_triangle(p, b, b, b).point, b);
  }
}

}  // namespace
}  // namespace sprung
