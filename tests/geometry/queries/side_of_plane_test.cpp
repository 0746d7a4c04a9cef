#include "geometry/queries/side_of_plane.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace sprung {
namespace {

__extension__ using Wide = __int128;
using Grid = Eigen::Matrix<std::int64_t, 3, 1>;

/// The sign in integer arithmetic: exact for coordinates below 2^40, because the determinant of their differences is below 6 *
/// 2^123.
int exact_sign(const Grid& a, const Grid& b, const Grid& c, const Grid& p) {
  const Grid u = b - a;
  const Grid v = c - a;
  const Grid w = p - a;
  const auto minor = [&](int i, int j) { return static_cast<Wide>(u[i]) * v[j] - static_cast<Wide>(u[j]) * v[i]; };
  const Wide volume = minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2];
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

int sign(double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; }

Vector3 scaled(const Grid& p, int exponent) { return p.cast<double>() * std::ldexp(1.0, exponent); }

TEST(SideOfPlane, IsPositiveOnTheSideOfTheNormal) {
  const Vector3 a(0, 0, 0);
  const Vector3 b(1, 0, 0);
  const Vector3 c(0, 1, 0);
  EXPECT_EQ(side_of_plane(a, b, c, Vector3(0.3, 0.2, 2.0)), 2.0);
  EXPECT_EQ(side_of_plane(a, b, c, Vector3(0.3, 0.2, -2.0)), -2.0);
  EXPECT_EQ(side_of_plane(a, b, c, Vector3(5.0, -3.0, 0.0)), 0.0);
}

TEST(SideOfPlane, HasTheExactSignNextToThePlane) {
  std::mt19937_64 random(1);
  const auto coordinate = [&] { return static_cast<std::int64_t>(random() >> 28) - (std::int64_t{1} << 35); };
  const auto few = [&] { return static_cast<std::int64_t>(random() % 17) - 8; };
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const Grid a(coordinate(), coordinate(), coordinate());
    const Grid b(coordinate(), coordinate(), coordinate());
    const Grid c(coordinate(), coordinate(), coordinate());
    Grid p = a + few() * (b - a) + few() * (c - a);
    if (i % 2 == 0) p[i / 2 % 3] += few();
    const int expected = exact_sign(a, b, c, p);
    zeros += expected == 0;
    for (const int exponent : {-60, -36, 0}) {
      ASSERT_EQ(sign(side_of_plane(scaled(a, exponent), scaled(b, exponent), scaled(c, exponent), scaled(p, exponent))), expected);
    }
  }
  EXPECT_GT(zeros, 10000);
}

TEST(SideOfPlane, HasTheExactSignIfDifferencesRound) {
  // 2^60 + 1 and 2^60 - 1 are not doubles, so every difference of a huge and a small coordinate rounds.
  const double huge = 0x1p60;
  const Vector3 a(huge, 0, 0);
  const Vector3 b(0, huge, 0);
  const Vector3 c(0, 0, huge);
  const Vector3 on(huge / 2, huge / 4, huge / 4);
  EXPECT_EQ(side_of_plane(a, b, c, on), 0.0);
  EXPECT_GT(side_of_plane(a, b, c, on + Vector3(0, 0, 64)), 0.0);
  EXPECT_LT(side_of_plane(a, b, c, Vector3(-1, 0.5, 0.25)), 0.0);
  EXPECT_EQ(side_of_plane(a, Vector3(-huge, 0, 0), Vector3(0, 0, 1), Vector3(1, 0x1p-40, 0)), 0x1p21);
}

TEST(SideOfPlane, ChangesSignWhenTwoCornersAreSwapped) {
  std::mt19937_64 random(2);
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a(coordinate(), coordinate(), coordinate());
    const Vector3 b(coordinate(), coordinate(), coordinate());
    const Vector3 c(coordinate(), coordinate(), coordinate());
    const Vector3 p(a + 0.25 * (b - a) + 0.5 * (c - a));
    ASSERT_EQ(sign(side_of_plane(a, b, c, p)), -sign(side_of_plane(b, a, c, p)));
    ASSERT_EQ(sign(side_of_plane(a, b, c, p)), sign(side_of_plane(b, c, a, p)));
    ASSERT_EQ(sign(side_of_plane(a, b, c, p)), -sign(side_of_plane(a, b, p, c)));
  }
}

TEST(SideOfLine, HasTheExactSignNextToTheLine) {
  std::mt19937_64 random(2);
  const auto coordinate = [&] { return static_cast<std::int64_t>(random() >> 28) - (std::int64_t{1} << 35); };
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t a[2] = {coordinate(), coordinate()};
    const std::int64_t b[2] = {coordinate(), coordinate()};
    const auto factor = static_cast<std::int64_t>(random() % 17) - 8;
    std::int64_t p[2] = {a[0] + factor * (b[0] - a[0]), a[1] + factor * (b[1] - a[1])};
    if (i % 2 == 0) p[i / 2 % 2] += static_cast<std::int64_t>(random() % 3) - 1;
    const Wide area = static_cast<Wide>(b[0] - a[0]) * (p[1] - a[1]) - static_cast<Wide>(b[1] - a[1]) * (p[0] - a[0]);
    const int expected = area > 0 ? 1 : area < 0 ? -1 : 0;
    zeros += expected == 0;
    for (const int exponent : {-60, -36, 0}) {
      const auto scaled_point = [&](const std::int64_t* q) {
        return Eigen::Vector2d(std::ldexp(static_cast<double>(q[0]), exponent), std::ldexp(static_cast<double>(q[1]), exponent));
      };
      ASSERT_EQ(sign(side_of_line(scaled_point(a), scaled_point(b), scaled_point(p))), expected);
    }
  }
  EXPECT_GT(zeros, 10000);
  EXPECT_GT(side_of_line({0, 0}, {1, 0}, {0.5, 1e-30}), 0.0);
}

}  // namespace
}  // namespace sprung
