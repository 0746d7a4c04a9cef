// The rope bridge: planks that attachments hold to ropes, under a ball that rolls over them.
#include "example_run.h"
#include "geometry/queries/closest_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace sprung {
namespace {

using testing::ExampleRun;

constexpr double kBall = 0.1;  // radius [m]

/// The distance of a point from a rope [m].
double distance(const Vector3& point, const Points& rope) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i + 1 < rope.cols(); ++i)
    least = std::min(least, closest_points_of_segments(point, point, rope.col(i), rope.col(i + 1)).squared_distance);
  return std::sqrt(least);
}

/// The corners below of a plank of 3 x 2 x 7 particles, those on the left rope first.
std::array<Vector3, 4> corners_of(const Points& plank) { return {plank.col(0), plank.col(2), plank.col(36), plank.col(38)}; }

/// The height of a rope at a place along the bridge [m].
double height_at(double x, const Points& rope) {
  for (Index i = 0; i + 1 < rope.cols(); ++i) {
    const double part = (x - rope(0, i)) / (rope(0, i + 1) - rope(0, i));
    if (part >= 0.0 && part <= 1.0) return rope(1, i) + part * (rope(1, i + 1) - rope(1, i));
  }
  return -std::numeric_limits<double>::infinity();
}

/// The angle by which the ball turns between two frames, forwards along x [rad].
double turn(const Points& before, const Points& after) {
  double sine = 0.0;
  double cosine = 0.0;
  const Vector3 centre_before = before.rowwise().mean();
  const Vector3 centre_after = after.rowwise().mean();
  for (Index i = 0; i < before.cols(); ++i) {
    const Vector3 a = before.col(i) - centre_before;
    const Vector3 b = after.col(i) - centre_after;
    sine += a.y() * b.x() - a.x() * b.y();
    cosine += a.x() * b.x() + a.y() * b.y();
  }
  return std::atan2(sine, cosine);
}

class RopeBridge : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { run = std::make_unique<ExampleRun>("rope_bridge"); }
  static void TearDownTestSuite() { run.reset(); }
  void SetUp() override { ASSERT_EQ(run->exit_code(), 0) << run->messages(); }

  static std::unique_ptr<ExampleRun> run;
};
std::unique_ptr<ExampleRun> RopeBridge::run;

// A rod leads to a point of the rope, so the rope is never farther than the rod is long.
TEST_F(RopeBridge, ThePlanksStayOnTheirRopes) {
  for (const char* const letter : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k"}) {
    const std::string plank = "plank_" + std::string(letter);
    const auto distances = [&](int frame) {
      std::array<double, 4> of_corners{};
      const std::array<Vector3, 4> corners = corners_of(run->positions(plank, frame));
      for (std::size_t k = 0; k < corners.size(); ++k)
        of_corners[k] = distance(corners[k], run->positions(k < 2 ? "rope_left" : "rope_right", frame));
      return of_corners;
    };
    const std::array<double, 4> lengths = distances(1);
    for (int frame = 2; frame <= run->frames(); ++frame) {
      const std::array<double, 4> now = distances(frame);
      for (std::size_t k = 0; k < now.size(); ++k) EXPECT_LE(now[k], 1.001 * lengths[k]) << plank << ", frame " << frame;
    }
  }
}

TEST_F(RopeBridge, TheBallRollsOverThemToTheOtherSide) {
  double path = 0.0;
  double turned = 0.0;
  double lowest_under_ball = std::numeric_limits<double>::infinity();
  Points before = run->positions("ball", 1);
  for (int frame = 2; frame <= run->frames(); ++frame) {
    const Points ball = run->positions("ball", frame);
    const Vector3 centre = ball.rowwise().mean();
    const Vector3 moved = centre - before.rowwise().mean();
    if (std::abs(centre.x()) < 0.8) {
      EXPECT_GT(centre.y(), height_at(centre.x(), run->positions("rope_left", frame)) + kBall) << "frame " << frame;
      path += moved.norm();
      turned += turn(before, ball);
    }
    if (std::abs(centre.x()) < 0.1) lowest_under_ball = std::min(lowest_under_ball, run->positions("plank_f", frame).row(1).mean());
    before = ball;
  }
  EXPECT_GT(before.row(0).mean(), 1.0) << "it reaches the other pier";
  EXPECT_NEAR(turned * kBall, path, 0.1 * path) << "it rolls";
  EXPECT_LT(lowest_under_ball, run->positions("plank_f", run->frames()).row(1).mean() - 0.01) << "the bridge sags under it";
}

}  // namespace
}  // namespace sprung
