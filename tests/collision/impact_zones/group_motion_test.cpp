// Rigid fit to the displacements of pins, and planes under an affine motion.
#include "collision/impact_zones/group_motion.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::Random;

std::vector<PinDisplacement> displacements_of(const RigidTransform& motion, const std::vector<Vector3>& pins) {
  std::vector<PinDisplacement> displacements;
  for (const Vector3& pin : pins) displacements.push_back({pin, motion * pin});
  return displacements;
}

RigidTransform random_motion(Random& random, double max_angle) {
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = Eigen::AngleAxisd(random.between(0.0, max_angle), random.direction()).toRotationMatrix();
  motion.translation() = random.direction();
  return motion;
}

// Coordinates up to 2 and some twenty roundings of 2^-53 each.
constexpr double kRounding = 0x1p-47;

TEST(PinRigidFit, MovesRigidPinsToTheirTargets) {
  Random random(1);
  const std::vector<std::vector<Vector3>> sets = {{{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.2, 0.0}, {0.3, 0.8, 0.0}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.2, 0.0}, {0.3, 0.8, 0.5}}};
  for (const std::vector<Vector3>& pins : sets) {
    for (int k = 0; k < 100; ++k) {
      const std::vector<PinDisplacement> moved_pins = displacements_of(random_motion(random, 1.5), pins);
      const auto motion = rigid_motion_of(moved_pins);
      ASSERT_TRUE(motion) << pins.size();
      for (const PinDisplacement& pin : moved_pins) EXPECT_LT((*motion * pin.from - pin.to).norm(), kRounding) << pins.size();
      EXPECT_NEAR(motion->linear().determinant(), 1.0, kRounding);
    }
  }
}

// The error of the rotation about the strip's long axis grows with the strip's length over its width.
TEST(PinRigidFit, MovesNarrowStripsToTheirTargetsUpToRounding) {
  Random random(3);
  for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
    std::vector<Vector3> pins;
    for (int k = 0; k < 24; ++k) {
      for (const double side : {-0.5, 0.5}) pins.emplace_back(k / 23.0, side * width, 0.0);
    }
    for (int k = 0; k < 50; ++k) {
      const std::vector<PinDisplacement> moved_pins = displacements_of(random_motion(random, 0.3), pins);
      const auto motion = rigid_motion_of(moved_pins);
      ASSERT_TRUE(motion) << width;
      for (const PinDisplacement& pin : moved_pins) {
        EXPECT_LT((*motion * pin.from - pin.to).norm(), std::min(kRounding / width, width)) << width;
      }
    }
  }
}

TEST(PinRigidFit, RotatesByTheSmallestAngleThatFits) {
  Random random(2);
  const std::vector<Vector3> pins = {{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}};
  const Vector3 along = (pins[1] - pins[0]).normalized();
  for (int k = 0; k < 100; ++k) {
    const RigidTransform rotation = random_motion(random, 1.5);
    const auto motion = rigid_motion_of(displacements_of(rotation, pins));
    ASSERT_TRUE(motion);
    const double least = std::acos(std::min(1.0, along.dot(rotation.linear() * along)));
    EXPECT_NEAR(Eigen::AngleAxisd(motion->linear()).angle(), least, 1e-7) << "the arc cosine loses half of the digits";
  }
}

TEST(PinRigidFit, IsEmptyForPinsAtRestOrInTranslation) {
  EXPECT_FALSE(rigid_motion_of(displacements_of(RigidTransform::Identity(), {{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}})));
  RigidTransform shift = RigidTransform::Identity();
  shift.translation() = Vector3(0.25, 0.5, -0.125);
  EXPECT_FALSE(rigid_motion_of(displacements_of(shift, {{1.0, 0.5, -0.25}, {-0.25, 0.5, 0.75}})));
}

TEST(PinRigidFit, IsEmptyForPinsThatMoveIndependently) {
  // Two pins pass each other; one of two pins moves.
  EXPECT_FALSE(
      rigid_motion_of(std::vector<PinDisplacement>{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{0.5, 0.0, 0.0}, {-0.5, 0.0, 0.0}}}));
  EXPECT_FALSE(
      rigid_motion_of(std::vector<PinDisplacement>{{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {{0.5, 0.0, 0.0}, {1.5, 0.0, 0.0}}}));
}

// Fewer than 64 terms of size 1.
constexpr double kHeightRounding = 64 * 0x1p-52;

TEST(MovedPlane, PointsThatFollowTheMotionKeepTheirHeightTimesTheVolume) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    Matrix3 gradient = Eigen::AngleAxisd(random.between(0.0, 1.5), random.direction()).toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) gradient.col(axis) += random.between(0.0, 0.3) * random.direction();
    const Vector3 normal = random.direction();
    const Vector3 offset = random.direction();
    const MovedPlane plane = moved_plane(normal, gradient);
    for (const double t : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const Matrix3 at_moment = (1.0 - t) * Matrix3::Identity() + t * gradient;
      const Vector3 at_time = (1.0 - t) * (1.0 - t) * plane.begin + 2.0 * t * (1.0 - t) * plane.middle + t * t * plane.end;
      EXPECT_NEAR(at_time.dot(at_moment * offset), at_moment.determinant() * normal.dot(offset), kHeightRounding);
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
