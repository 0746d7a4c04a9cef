#include "collision/sample_meshes.h"
#include "collision/shapes/obstacle_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using test::Random;

std::vector<ObstacleGeometry> solids() {
  return {SphereGeometry{0.7},
          BoxGeometry{Vector3(0.6, 1.4, 1.0)},
          CapsuleGeometry{0.4, 0.9},
          CylinderGeometry{0.5, 1.2},
          ConeGeometry{0.6, 1.3},
          EllipsoidGeometry{Vector3(0.9, 0.3, 0.6)},
          EllipsoidGeometry{Vector3(0.9, 0.02, 0.9)},
          HalfSpaceGeometry{Vector3(1.0, 2.0, -2.0) / 3.0, 0.2}};
}

const Box3 kAround(Vector3::Constant(-1.6), Vector3::Constant(1.6));

TEST(PrimitiveCrossing, APathThatEndsInsideCrossesTheSurface) {
  for (const ObstacleGeometry& geometry : solids()) {
    const auto shape = make_shape(geometry);
    Random random(5);
    int entering = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3 a = random.in_box(kAround);
      const Vector3 b = random.in_box(kAround);
      if (shape->contains(a)) continue;
      const auto crossing = shape->first_crossing(a, b);
      if (shape->contains(b)) {
        ++entering;
        ASSERT_TRUE(crossing) << geometry.index();
      }
      if (!crossing) continue;
      ASSERT_LT(crossing->normal.dot(b - a), 1e-12);
      // The path is outside before the crossing and on the surface at it, within rounding of coordinates below 2 m.
      for (const double fraction : {0.0, 0.5, 0.9, 0.999, 1.0}) {
        const double distance = shape->nearest(a + fraction * crossing->fraction * (b - a), 10.0)->distance;
        ASSERT_GE(distance, -1e-14) << geometry.index();
        if (fraction == 1.0) {
          ASSERT_LE(distance, 1e-13) << geometry.index();
        }
      }
    }
    EXPECT_GT(entering, 20) << geometry.index();
  }
}

TEST(PrimitiveCrossing, APathWithoutACrossingStaysOutside) {
  for (const ObstacleGeometry& geometry : solids()) {
    const auto shape = make_shape(geometry);
    Random random(6);
    for (int i = 0; i < 2000; ++i) {
      const Vector3 a = random.in_box(kAround);
      const Vector3 b = random.in_box(kAround);
      if (shape->first_crossing(a, b) || shape->contains(a)) continue;
      for (int k = 0; k <= 100; ++k) ASSERT_FALSE(shape->contains(a + 0.01 * k * (b - a))) << geometry.index();
    }
  }
}

TEST(PrimitiveCrossing, APathAlongAFaceDoesNotCrossAtAnySpeed) {
  const auto shape = make_shape(BoxGeometry{Vector3(1000.0, 1.0, 1000.0)});
  EXPECT_FALSE(shape->first_crossing(Vector3(-400, 0.500001, 0), Vector3(400, 0.500001, 0)));
  const auto crossing = shape->first_crossing(Vector3(-400, 0.500001, 0), Vector3(400, 0.499999, 0));
  ASSERT_TRUE(crossing);
  // The crossing is early by half the rounding tolerance, 0.5e-14 of coordinates of 900 m, on a path that descends by 2e-6 m.
  EXPECT_NEAR(crossing->fraction, 0.5, 4.5e-12 / 2e-6);
  EXPECT_EQ(crossing->normal, Vector3::UnitY());
}

TEST(PrimitiveCrossing, AParticleInsideMayLeaveAndOneOnTheSurfaceMayNotEnter) {
  const auto shape = make_shape(SphereGeometry{1.0});
  EXPECT_FALSE(shape->first_crossing(Vector3(0.2, 0, 0), Vector3(3, 0, 0)));
  EXPECT_FALSE(shape->first_crossing(Vector3(1, 0, 0), Vector3(3, 0, 0)));
  EXPECT_FALSE(shape->first_crossing(Vector3(1, 0, 0), Vector3(1, 0, 0)));
  const auto crossing = shape->first_crossing(Vector3(1, 0, 0), Vector3(0.5, 0, 0));
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->fraction, 0.0);
  EXPECT_EQ(crossing->normal, Vector3::UnitX());
}

}  // namespace
}  // namespace sprung
