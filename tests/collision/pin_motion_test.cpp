// The motion with which pins take along what hangs on them.
#include "collision/pin_motion.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::Random;

std::vector<PinWay> ways(const RigidTransform& motion, const std::vector<Vector3>& pins) {
  std::vector<PinWay> ways;
  for (const Vector3& pin : pins) ways.push_back({pin, motion * pin});
  return ways;
}

RigidTransform random_motion(Random& random, double most_angle) {
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = Eigen::AngleAxisd(random.between(0.0, most_angle), random.direction()).toRotationMatrix();
  motion.translation() = random.direction();
  return motion;
}

// Coordinates up to 2 and some twenty roundings of 2^-53 each.
constexpr double kRounding = 0x1p-47;

TEST(PinMotion, TakesPinsThatMoveRigidlyWhereTheyGo) {
  Random random(1);
  const std::vector<std::vector<Vector3>> sets = {{{1.0, 0.5, -0.3}},
                                                  {{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.2, 0.0}, {0.3, 0.8, 0.0}},
                                                  {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.0, 0.2, 0.0}, {0.3, 0.8, 0.5}}};
  for (const std::vector<Vector3>& pins : sets) {
    for (int k = 0; k < 100; ++k) {
      const std::vector<PinWay> pin_ways = ways(random_motion(random, 3.0), pins);
      const RigidTransform motion = common_motion(pin_ways);
      for (const PinWay& pin : pin_ways) EXPECT_LT((motion * pin.from - pin.to).norm(), kRounding) << pins.size();
      EXPECT_NEAR(motion.linear().determinant(), 1.0, kRounding);
    }
  }
}

TEST(PinMotion, TurnsNoMoreThanPinsAskFor) {
  Random random(2);
  const std::vector<Vector3> pins = {{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}};
  const Vector3 along = (pins[1] - pins[0]).normalized();
  for (int k = 0; k < 100; ++k) {
    const RigidTransform turned = random_motion(random, 3.0);
    const Matrix3 turn = common_motion(ways(turned, pins)).linear();
    const double least = std::acos(std::min(1.0, along.dot(turned.linear() * along)));
    EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), least, 1e-7) << "the arc cosine loses half of the digits";
  }
}

TEST(PinMotion, OfPinsThatRestOrGoTheSameWayIsNoTurnAtAll) {
  const std::vector<Vector3> pins = {{1.0, 0.5, -0.3}, {-0.2, 0.4, 0.6}, {0.1, 0.7, 0.2}};
  EXPECT_EQ(common_motion(ways(RigidTransform::Identity(), pins)).matrix(), RigidTransform::Identity().matrix());
  RigidTransform shift = RigidTransform::Identity();
  shift.translation() = Vector3(0.25, 0.5, -0.125);
  EXPECT_EQ(common_motion(ways(shift, pins)).linear(), Matrix3::Identity());
}

}  // namespace
}  // namespace sprung
