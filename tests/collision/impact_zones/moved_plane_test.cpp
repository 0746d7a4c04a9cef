#include "collision/impact_zones/moved_plane.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

// Fewer than 64 terms of size 1.
constexpr double kRounding = 64 * 0x1p-52;

TEST(MovedPlane, PointsThatFollowTheMotionKeepTheirHeightTimesTheVolume) {
  test::Random random(1);
  for (int n = 0; n < 1000; ++n) {
    Matrix3 gradient = Eigen::AngleAxisd(random.between(0.0, 1.5), random.direction()).toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) gradient.col(axis) += random.between(0.0, 0.3) * random.direction();
    const Vector3 normal = random.direction();
    const Vector3 offset = random.direction();
    const MovedPlane plane = moved_plane(normal, gradient);
    for (const double t : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const Matrix3 at_moment = (1.0 - t) * Matrix3::Identity() + t * gradient;
      const Vector3 at_time = (1.0 - t) * (1.0 - t) * plane.begin + 2.0 * t * (1.0 - t) * plane.middle + t * t * plane.end;
      EXPECT_NEAR(at_time.dot(at_moment * offset), at_moment.determinant() * normal.dot(offset), kRounding);
    }
  }
}

TEST(MovedPlane, IsConstantUnderATranslation) {
  const MovedPlane plane = moved_plane(Vector3::UnitY(), Matrix3::Identity());
  EXPECT_TRUE(plane.is_constant());
  EXPECT_EQ(plane.middle, plane.begin);
}

}  // namespace
}  // namespace sprung
