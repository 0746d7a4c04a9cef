// The common motion of blocked.
#include "collision/obstacle_regions/blocked_vertex.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sprung {
namespace {

using test::Random;

const RigidTransform kPose = Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(0.4, Vector3(0.6, 0.0, 0.8));

MovedTriangle moved_triangle(const AffineTransform& map, Random& random) {
  MovedTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.before[k] = random.in_box({-Vector3::Ones(), Vector3::Ones()});
    triangle.after[k] = map * triangle.before[k];
  }
  return triangle;
}

TEST(CommonMotion, OfAnchorsOnARigidObstacleIsTheObstaclesMotion) {
  const std::vector<BlockedVertex> blocked{
      {.particle = 0}, {.particle = 1, .obstacle = 0, .motion = kPose}, {.particle = 2, .obstacle = 1}};
  EXPECT_EQ(common_motion(blocked).matrix(), kPose.matrix());
}

TEST(CommonMotion, OfRestingAnchorsIsTheIdentity) {
  const std::vector<BlockedVertex> blocked{{.particle = 0}, {.particle = 1}};
  EXPECT_EQ(common_motion(blocked).matrix(), AffineTransform::Identity().matrix());
}

// Two triangles that are not in one plane determine an affine map. The error is rounding, 1e-16, times the squared ratio of the
// corners' spreads in two directions: at most 2^20.
TEST(CommonMotion, OfTwoTrianglesOnADeformingSurfaceIsTheirAffineMap) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    AffineTransform map(kPose);
    for (double& entry : map.linear().reshaped()) entry += random.between(-0.1, 0.1);
    std::vector<BlockedVertex> blocked;
    for (Index k = 0; k < 2; ++k) {
      blocked.push_back({.particle = k, .obstacle = 0, .motion = kPose, .surface = moved_triangle(map, random)});
    }
    EXPECT_LT((common_motion(blocked).matrix() - map.matrix()).norm(), 1e-9) << "trial " << trial;
  }
}

// Across its plane a single triangle does not determine the map: there it equals the rigid motion.
TEST(CommonMotion, OfASingleTriangleMapsTheTriangleExactly) {
  Random random(4);
  AffineTransform map(kPose);
  map.linear() *= 1.2;
  const MovedTriangle triangle = moved_triangle(map, random);
  const std::vector<BlockedVertex> blocked{{.particle = 0, .obstacle = 0, .motion = kPose, .surface = triangle}};
  const AffineTransform found = common_motion(blocked);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((found * triangle.before[k] - triangle.after[k]).norm(), 1e-12);
  const Vector3 across = (triangle.before[1] - triangle.before[0]).cross(triangle.before[2] - triangle.before[0]);
  EXPECT_LT((found.linear() * across - kPose.linear() * across).norm(), 1e-12);
}

// For a surface that turns inside out the fit is rejected and only the translation of its centre is kept.
TEST(CommonMotion, NeverTurnsItsGroupInsideOut) {
  Random random(5);
  AffineTransform mirror = AffineTransform::Identity();
  mirror.linear()(0, 0) = -1.0;
  std::vector<BlockedVertex> blocked;
  for (Index k = 0; k < 3; ++k) blocked.push_back({.particle = k, .obstacle = 0, .surface = moved_triangle(mirror, random)});
  EXPECT_GT(common_motion(blocked).linear().determinant(), 0.0);
}

}  // namespace
}  // namespace sprung
