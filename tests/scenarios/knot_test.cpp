// The determinants of known knots.
#include "scenarios/knot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sprung::testing {
namespace {

/// The knot that winds `around` times around a torus and `through` times through its hole.
Points torus_knot(int around, int through) {
  Points x(3, 200);
  for (Index i = 0; i < x.cols(); ++i) {
    const double t = 2.0 * std::numbers::pi * i / static_cast<double>(x.cols());
    const double r = 2.0 + std::cos(through * t);
    x.col(i) = Vector3(r * std::cos(around * t), r * std::sin(around * t), std::sin(through * t));
  }
  return x;
}

TEST(Knot, ARingIsNoKnot) {
  EXPECT_EQ(knot_determinant(torus_knot(1, 0)), 1);
  EXPECT_EQ(knot_determinant(torus_knot(1, 7)), 1) << "a coil";
}

TEST(Knot, TorusKnotsHaveTheirDeterminants) {
  EXPECT_EQ(knot_determinant(torus_knot(2, 3)), 3);
  EXPECT_EQ(knot_determinant(torus_knot(3, 2)), 3) << "the same knot in another projection";
  EXPECT_EQ(knot_determinant(torus_knot(2, 5)), 5);
  EXPECT_EQ(knot_determinant(torus_knot(2, 7)), 7);
  EXPECT_EQ(knot_determinant(torus_knot(3, 4)), 3);
}

TEST(Knot, AFigureOfEightHasDeterminantFive) {
  Points x(3, 200);
  for (Index i = 0; i < x.cols(); ++i) {
    const double t = 2.0 * std::numbers::pi * i / static_cast<double>(x.cols());
    const double r = 2.0 + std::cos(2.0 * t);
    x.col(i) = Vector3(r * std::cos(3.0 * t), r * std::sin(3.0 * t), std::sin(4.0 * t));
  }
  EXPECT_EQ(knot_determinant(x), 5);
}

TEST(Knot, AnOverhandKnotIsUndoneWhenTheRopePassesThroughItself) {
  Points rope(3, 81);
  for (Index i = 0; i < rope.cols(); ++i) {
    const double t = 4.4 * i / 80.0 - 2.2;
    rope.col(i) = Vector3(t * t * t - 3.0 * t, t * t * t * t - 4.0 * t * t, std::pow(t, 5) / 5.0 - 2.0 * t);
  }
  EXPECT_EQ(knot_determinant(closed_far_away(rope)), 3);
  rope.row(2) *= 0.0;
  rope.row(2).setLinSpaced(0.0, 1.0);
  EXPECT_EQ(knot_determinant(closed_far_away(rope)), 1) << "the same projection, rising throughout";
}

}  // namespace
}  // namespace sprung::testing
