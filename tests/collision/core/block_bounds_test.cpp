#include "collision/core/block_bounds.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Points four_positions() {
  Points positions(3, 4);
  positions << 1.0, -2.0, 0.5, 9.0,  //
      4.0, 3.0, 5.0, 9.0,            //
      -1.0, 0.0, -7.0, 9.0;
  return positions;
}

void expect_same(const Box3& box, const Vector3& low, const Vector3& high) {
  EXPECT_EQ(box.min(), low);
  EXPECT_EQ(box.max(), high);
}

TEST(FiniteBounds, AreThoseOfARangeAndOfAList) {
  const Points positions = four_positions();
  expect_same(finite_bounds(positions, 0, 3), {-2.0, 3.0, -7.0}, {1.0, 5.0, 0.0});
  expect_same(finite_bounds(positions, std::array<Index, 2>{0, 2}), {0.5, 4.0, -7.0}, {1.0, 5.0, -1.0});
}

TEST(FiniteBounds, LeaveOutPositionsThatAreNotFinite) {
  for (const double strange : {kNan, kInfinity, -kInfinity}) {
    for (Index row = 0; row < 3; ++row) {
      Points positions = four_positions();
      positions(row, 3) = strange;  // whose other coordinates are beyond all others
      expect_same(finite_bounds(positions, 0, 4), {-2.0, 3.0, -7.0}, {1.0, 5.0, 0.0});
      expect_same(finite_bounds(positions, std::array<Index, 2>{3, 0}), positions.col(0), positions.col(0));
    }
  }
}

TEST(FiniteBounds, OfNothingAreEmpty) {
  EXPECT_TRUE(finite_bounds(four_positions(), 2, 2).isEmpty());
  EXPECT_TRUE(finite_bounds(Points::Constant(3, 2, kNan), 0, 2).isEmpty());
}

}  // namespace
}  // namespace sprung
