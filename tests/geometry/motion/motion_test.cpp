#include "geometry/motion/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace sprung {
namespace {

// A few products and one sine of numbers near 1: a few units in the last place.
constexpr double kRounding = 1e-15;

RigidTransform placed_at(const Vector3& position, const Vector3& degrees = Vector3::Zero()) {
  RigidTransform placed = RigidTransform::Identity();
  placed.linear() = rotation_from_degrees(degrees);
  placed.translation() = position;
  return placed;
}

bool same(const RigidTransform& a, const RigidTransform& b) { return a.matrix() == b.matrix(); }

TEST(RotationFromDegrees, TurnsAboutFixedAxesXThenYThenZ) {
  const Vector3 degrees(20.0, -70.0, 200.0);
  const Vector3 radians = degrees * std::numbers::pi / 180.0;
  const Matrix3 expected = (Eigen::AngleAxisd(radians.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(radians.y(), Vector3::UnitY()) *
                            Eigen::AngleAxisd(radians.x(), Vector3::UnitX()))
                               .toRotationMatrix();
  EXPECT_LE((rotation_from_degrees(degrees) - expected).cwiseAbs().maxCoeff(), kRounding);
}

TEST(RotationFromDegrees, IsExactForQuarterTurns) {
  EXPECT_EQ(rotation_from_degrees({90, 0, 0}) * Vector3(1, 2, 3), Vector3(1, -3, 2));
  EXPECT_EQ(rotation_from_degrees({0, 90, 0}) * Vector3(1, 2, 3), Vector3(3, 2, -1));
  EXPECT_EQ(rotation_from_degrees({0, 0, -90}) * Vector3(1, 2, 3), Vector3(2, -1, 3));
  EXPECT_EQ(rotation_from_degrees({0, 180, 0}) * Vector3(1, 2, 3), Vector3(-1, 2, -3));
  EXPECT_EQ(rotation_from_degrees({360, 720, -360}), Matrix3::Identity());
}

TEST(Motion, WithoutKeyframesAndSpinKeepsThePlacedPose) {
  const RigidTransform placed = placed_at({1, 2, 3}, {10, 20, 30});
  EXPECT_FALSE(Motion{}.moves());
  EXPECT_TRUE(same(Motion{}.pose(placed, 7.5), placed));
}

TEST(Motion, EndsWithItsLastKeyframeAndNeverWithASpin) {
  EXPECT_EQ(Motion{}.end(), 0.0);
  EXPECT_EQ((Motion{.keyframes = {{1.0, {1, 0, 0}, {0, 0, 0}}, {2.5, {5, 0, 0}, {0, 90, 0}}}}.end()), 2.5);
  EXPECT_EQ((Motion{.spin = {0, 90, 0}}.end()), std::numeric_limits<double>::infinity());
}

TEST(Motion, IsConstantOutsideItsKeyframes) {
  const Motion motion{.keyframes = {{1.0, {1, 0, 0}, {0, 0, 0}}, {2.0, {5, 0, 0}, {0, 90, 0}}}};
  const RigidTransform placed = placed_at({0, 1, 0});
  EXPECT_TRUE(same(motion.pose(placed, -3.0), placed_at({1, 1, 0})));
  EXPECT_TRUE(same(motion.pose(placed, 1.0), placed_at({1, 1, 0})));
  EXPECT_TRUE(same(motion.pose(placed, 2.0), placed_at({5, 1, 0}, {0, 90, 0})));
  EXPECT_TRUE(same(motion.pose(placed, 9.0), placed_at({5, 1, 0}, {0, 90, 0})));
}

TEST(Motion, InterpolatesComponentsLinearly) {
  const Motion motion{.keyframes = {{0.0, {0, 0, 0}, {0, 0, 0}}, {2.0, {4, 8, 0}, {0, 0, 180}}}};
  EXPECT_TRUE(same(motion.pose(placed_at({0, 0, 0}), 0.5), placed_at({1, 2, 0}, {0, 0, 45})));
}

TEST(Motion, SmoothStartsAndEndsAtRest) {
  const Motion motion{.keyframes = {{0.0, {0, 0, 0}, {0, 0, 0}}, {1.0, {1, 0, 0}, {0, 0, 0}}},
                      .interpolation = Interpolation::smooth};
  const auto x = [&](double time) { return motion.pose(placed_at({0, 0, 0}), time).translation().x(); };
  EXPECT_EQ(x(0.0), 0.0);
  EXPECT_EQ(x(0.25), 0.15625);  // 3 / 16 - 2 / 64
  EXPECT_EQ(x(0.5), 0.5);
  EXPECT_EQ(x(1.0), 1.0);
  // 3 s^2 - 2 s^3 is below 3 s^2 near both ends.
  EXPECT_LT(x(1e-3), 3e-6);
  EXPECT_LT(1.0 - x(1.0 - 1e-3), 3e-6);
}

TEST(Motion, KeyframesFrom0To360MakeAFullTurn) {
  const Motion motion{.keyframes = {{0.0, {0, 0, 0}, {0, 0, 0}}, {4.0, {0, 0, 0}, {0, 360, 0}}}};
  EXPECT_TRUE(motion.moves());
  for (const double time : {1.0, 2.0, 3.0}) {
    EXPECT_TRUE(same(motion.pose(placed_at({0, 0, 0}), time), placed_at({0, 0, 0}, {0, 90 * time, 0}))) << time;
  }
  EXPECT_TRUE(same(motion.pose(placed_at({0, 0, 0}), 4.0), placed_at({0, 0, 0})));
}

TEST(Motion, TurnsAboutThePlacedOriginAfterThePlacedRotation) {
  const Motion motion{.keyframes = {{0.0, {0, 0, 0}, {0, 0, 90}}}};
  const RigidTransform pose = motion.pose(placed_at({10, 0, 0}, {90, 0, 0}), 0.0);
  // The placed rotation maps (0, 1, 0) to (0, 0, 1), which a turn about z does not change.
  EXPECT_EQ(pose * Vector3(0, 1, 0), Vector3(10, 0, 1));
  EXPECT_EQ(pose * Vector3(1, 0, 0), Vector3(10, 1, 0));
  EXPECT_FALSE(motion.moves());
}

TEST(Motion, SpinTurnsAtAConstantRateWithoutEnd) {
  const Motion motion{.spin = {0, 90, 0}};
  EXPECT_TRUE(motion.moves());
  EXPECT_TRUE(same(motion.pose(placed_at({1, 0, 0}), 1.0), placed_at({1, 0, 0}, {0, 90, 0})));
  EXPECT_TRUE(same(motion.pose(placed_at({1, 0, 0}), 4001.0), placed_at({1, 0, 0}, {0, 90, 0})));
}

TEST(Motion, SpinIsAnAngularVelocityVector) {
  const Motion motion{.spin = {30, -40, 120}};  // length 130
  const Eigen::AngleAxisd expected(0.7 * 130.0 * std::numbers::pi / 180.0, Vector3(30, -40, 120) / 130.0);
  EXPECT_LE((motion.pose(placed_at({0, 0, 0}), 0.7).linear() - expected.toRotationMatrix()).cwiseAbs().maxCoeff(), kRounding);
}

TEST(Motion, TurnAddsUpBackAndForth) {
  const Motion motion{.keyframes = {{.time = 0.0}, {.time = 1.0, .rotation = {0.0, 80.0, 0.0}}, {.time = 2.0}},
                      .spin = {0.0, 30.0, 40.0}};
  EXPECT_EQ(motion.rotation(0.5, 0.75), 0.25 * (80.0 + 50.0));
  EXPECT_EQ(motion.rotation(0.5, 1.25), 0.75 * (80.0 + 50.0));
  EXPECT_EQ(motion.rotation(1.0, 2.0), 80.0 + 50.0);
  EXPECT_EQ(motion.rotation(3.0, 5.0), 2.0 * 50.0);
  EXPECT_EQ(Motion{}.rotation(0.0, 1.0), 0.0);
}

TEST(Motion, EqualKeyframesDoNotMove) {
  const Motion motion{.keyframes = {{0.0, {1, 2, 3}, {4, 5, 6}}, {1.0, {1, 2, 3}, {4, 5, 6}}}};
  EXPECT_FALSE(motion.moves());
}

/// For slerp: two arcus functions, three sines and a few dozen products of numbers up to 3.
bool nearly_same(const RigidTransform& a, const RigidTransform& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() < 20 * kRounding;
}

/// From one pose to another between 1 s and 3 s: 1 m along x, and a rotation by 100 degrees about z.
Motion posed_motion() {
  RigidTransform begin = placed_at({1, 2, 3}, {0, 0, 20});
  RigidTransform end = placed_at({2, 2, 3}, {0, 0, 120});
  return {
      .keyframes = {{.time = 0.0}, {.time = 1.0, .position = {5, 5, 5}}}, .spin = {0, 0, 7}, .poses = {{1.0, begin}, {3.0, end}}};
}

TEST(MotionByPoses, IsExactAtItsTimesAndConstantOutside) {
  const Motion motion = posed_motion();
  const RigidTransform placed = placed_at({9, 9, 9}, {10, 20, 30});
  for (const double time : {0.0, 1.0}) EXPECT_EQ(motion.pose(placed, time).matrix(), motion.poses[0].pose.matrix());
  for (const double time : {3.0, 4.0}) EXPECT_EQ(motion.pose(placed, time).matrix(), motion.poses[1].pose.matrix());
}

TEST(MotionByPoses, MovesOnALineAndTurnsAtAConstantRate) {
  const Motion motion = posed_motion();
  for (const double fraction : {0.25, 0.5, 0.9}) {
    const RigidTransform expected = placed_at({1 + fraction, 2, 3}, {0, 0, 20 + 100 * fraction});
    EXPECT_TRUE(nearly_same(motion.pose({}, 1.0 + 2.0 * fraction), expected)) << "fraction " << fraction;
  }
}

TEST(MotionByPoses, TurnsTheShorterWay) {
  const Motion motion{.poses = {{0.0, placed_at({0, 0, 0})}, {1.0, placed_at({0, 0, 0}, {0, 200, 0})}}};
  EXPECT_TRUE(nearly_same(motion.pose({}, 0.5), placed_at({0, 0, 0}, {0, -80, 0})));
  EXPECT_NEAR(motion.rotation(0.0, 1.0), 160.0, 1e-6);
}

// acos of a number near 1 has half of its digits.
TEST(MotionByPoses, KnowsWhetherHowFarAndHowLongItMoves) {
  const Motion motion = posed_motion();
  EXPECT_TRUE(motion.moves());
  EXPECT_EQ(motion.end(), 3.0);
  EXPECT_NEAR(motion.rotation(1.0, 3.0), 100.0, 1e-6);
  EXPECT_NEAR(motion.rotation(2.0, 2.5), 100.0, 1e-6) << "an upper bound";
  EXPECT_EQ(motion.rotation(3.0, 4.0), 0.0);
  EXPECT_EQ(motion.rotation(0.0, 1.0), 0.0);
  Motion still = motion;
  still.poses[1].pose = still.poses[0].pose;
  EXPECT_FALSE(still.moves()) << "whatever its keyframes and its spin say";
  EXPECT_EQ(still.end(), 0.0);
}

}  // namespace
}  // namespace sprung
