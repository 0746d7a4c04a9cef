// No particle ends behind a surface in front of which it began, judged by exact predicates over all triangles.
#include "collision/environment.h"
#include "collision/sample_meshes.h"
#include "geometry/side_of_plane.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using test::Random;

/// Whether the path meets any triangle; touching counts, and so does every side.
bool crosses(const TriangleMesh& mesh, const Vector3& a, const Vector3& b) {
  const auto sign = [](double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; };
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    Vector3 x[3];
    for (int k = 0; k < 3; ++k) x[k] = mesh.vertices.col(mesh.triangles(k, t));
    const int begin = sign(side_of_plane(x[0], x[1], x[2], a));
    const int end = sign(side_of_plane(x[0], x[1], x[2], b));
    if (begin == end) continue;
    int low = 1;
    int high = -1;
    for (int k = 0; k < 3; ++k) {
      const int edge = sign(side_of_plane(a, b, x[k], x[(k + 1) % 3]));
      low = std::min(low, edge);
      high = std::max(high, edge);
    }
    if (low >= 0 || high <= 0) return true;
  }
  return false;
}

Obstacle mesh_obstacle(const TriangleMesh& mesh, bool closed) {
  Obstacle result;
  result.name = "mesh";
  result.geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), closed};
  return result;
}

/// Kicks particles around an obstacle for many steps; after each, no local path may cross any triangle.
void expect_no_crossing(const Obstacle& obstacle, Index count, int steps, double kick) {
  Environment environment({obstacle});
  const TriangleMesh& mesh = *std::get<MeshGeometry>(obstacle.geometry).mesh;
  const bool closed = std::get<MeshGeometry>(obstacle.geometry).closed;
  Random random(31);
  Points x(3, count);
  const RigidTransform start = obstacle.motion.pose(obstacle.placed, 0.0);
  for (Index i = 0; i < count; ++i) {
    Vector3 p = test::near_surface(mesh, random, 0.2);
    while (closed && test::winding_number(mesh, p) > 0.5) p = test::near_surface(mesh, random, 0.3);
    x.col(i) = start * p;
  }
  const std::vector<char> held(static_cast<std::size_t>(count), 0);
  Index moved = 0;
  for (int step = 0; step < steps; ++step) {
    environment.set_interval(0.01 * step, 0.01 * (step + 1));
    Points after = x;
    for (Index i = 0; i < count; ++i) {
      // Most are thrown at the surface, straight at some vertex.
      const Vector3 target = environment.pose_after(0) * mesh.vertices.col(random.below(static_cast<Index>(mesh.vertices.cols())));
      const Vector3 at = target - x.col(i);
      after.col(i) += i % 3 == 0 ? Vector3(kick * random.direction()) : Vector3(random.between(0.0, 2.0) * at);
    }
    Index squeezed = 0;
    moved += static_cast<Index>(environment.truncate(x, after, held, squeezed).size());
    ASSERT_EQ(squeezed, 0);
    for (Index i = 0; i < count; ++i) {
      const Vector3 a = environment.pose_before(0).inverse() * x.col(i);
      const Vector3 b = environment.pose_after(0).inverse() * after.col(i);
      ASSERT_FALSE(crosses(mesh, a, b)) << "particle " << i << " in step " << step;
    }
    x = after;
  }
  EXPECT_GT(moved, count);
  if (!closed) return;
  for (Index i = 0; i < count; ++i) {
    ASSERT_LT(test::winding_number(mesh, environment.pose_after(0).inverse() * x.col(i)), 0.5);
  }
}

TEST(Truncation, NothingPassesAClosedMesh) { expect_no_crossing(mesh_obstacle(test::torus(1.0, 0.3, 20, 10), true), 200, 40, 1.0); }

TEST(Truncation, NothingPassesNeedles) { expect_no_crossing(mesh_obstacle(test::needles(12), true), 200, 40, 0.5); }

TEST(Truncation, NothingPassesAnOpenMesh) {
  expect_no_crossing(mesh_obstacle(test::terrain(8, [](Index i, Index j) { return 0.3 * ((i + 2 * j) % 3); }), false), 200, 40,
                     1.0);
}

TEST(Truncation, NothingPassesATurningMesh) {
  Obstacle wheel = mesh_obstacle(test::torus(1.0, 0.3, 20, 10), true);
  wheel.motion.spin = Vector3(400.0, 900.0, -300.0);
  wheel.motion.keyframes = {{0.0}, {0.2, Vector3(4.0, 0.0, 0.0)}, {0.4}};
  expect_no_crossing(wheel, 200, 40, 0.5);
}

TEST(Truncation, ThinSheetHoldsAt500MetresPerSecondFromEitherSide) {
  const Environment environment({mesh_obstacle(test::flat_sheet(4), false)});
  constexpr double kMove = 500.0 / 60.0;
  Points before(3, 4);
  before << 0.3, 0.3, 0.0, 0.5, 0.01, -0.01, 0.01, -0.01, 0.4, 0.4, 0.0, 0.5;  // the last two over a vertex and an edge
  Points after = before;
  after.row(1) -= Eigen::RowVector4d(kMove, -kMove, kMove, -kMove);
  Index squeezed = 0;
  const auto moved = environment.truncate(before, after, {0, 0, 0, 0}, squeezed);
  EXPECT_EQ(moved.size(), 4U);
  EXPECT_EQ(squeezed, 0);
  for (Index i = 0; i < 4; ++i) EXPECT_GT(after(1, i) * before(1, i), 0.0) << i;
}

TEST(Truncation, PressedForEverAParticleStaysInFront) {
  const Environment environment({mesh_obstacle(test::flat_sheet(4), false)});
  Points x = Vector3(0.3, 0.01, 0.4);
  Index squeezed = 0;
  for (int step = 0; step < 10000; ++step) {
    Points after = x;
    after(1, 0) -= 0.05;
    after(0, 0) += 0.01 * ((step / 50) % 2 == 0 ? 1 : -1);
    environment.truncate(x, after, {0}, squeezed);
    x = after;
    ASSERT_GT(x(1, 0), 0.0) << step;
    ASSERT_EQ(squeezed, 0);
  }
}

TEST(Truncation, AnObstacleThatComesCarriesARestingParticle) {
  Obstacle sheet = mesh_obstacle(test::flat_sheet(4), false);
  sheet.placed.translation() = Vector3(0.0, -1.0, 0.0);
  sheet.motion.keyframes = {{0.0}, {0.1, Vector3(0.0, 50.0, 0.0)}};
  Environment environment({sheet});
  environment.set_interval(0.0, 0.1);
  const Points rest = Vector3(0.1, 0.0, 0.2);
  Points after = rest;
  Index squeezed = 0;
  EXPECT_EQ(environment.truncate(rest, after, {0}, squeezed).size(), 1U);
  EXPECT_GT(after(1, 0), 49.0);
  EXPECT_LT(after(1, 0), 50.0);
  EXPECT_EQ(squeezed, 0);
}

TEST(Truncation, HeldParticlesAreLeftAloneAndFreePathsKeepEveryBit) {
  const Environment environment({mesh_obstacle(test::flat_sheet(4), false)});
  Points before(3, 2);
  before << 0.3, 0.3, 1.0, 1.0, 0.4, 0.4;
  Points after = before;
  after(1, 0) = -1.0;
  after(1, 1) = 0.1 / 3.0;
  const Points wanted = after;
  Index squeezed = 0;
  EXPECT_TRUE(environment.truncate(before, after, {1, 0}, squeezed).empty());
  EXPECT_EQ(after, wanted);
}

TEST(Truncation, ObstaclesThatCloseInAreReported) {
  Obstacle upper = mesh_obstacle(test::flat_sheet(4), false);
  Obstacle lower = upper;
  upper.placed.translation() = Vector3(0.0, 1.0, 0.0);
  lower.placed.translation() = Vector3(0.0, -1.0, 0.0);
  upper.motion.keyframes = {{0.0}, {1.0, Vector3(0.0, -1.5, 0.0)}};
  lower.motion.keyframes = {{0.0}, {1.0, Vector3(0.0, 1.5, 0.0)}};
  Environment environment({upper, lower});
  environment.set_interval(0.0, 1.0);
  const Points rest = Vector3(0.1, 0.0, 0.2);
  Points after = rest;
  Index squeezed = 0;
  EXPECT_EQ(environment.truncate(rest, after, {0}, squeezed).size(), 1U);
  EXPECT_EQ(squeezed, 1);
}

TEST(Truncation, InAWedgeOfTwoObstaclesAParticleFindsAPlace) {
  Obstacle left = mesh_obstacle(test::flat_sheet(8), false);
  Obstacle right = left;
  left.placed.linear() = rotation_from_degrees(Vector3(0.0, 0.0, -60.0));
  right.placed.linear() = rotation_from_degrees(Vector3(0.0, 0.0, 60.0));
  const Environment environment({left, right});
  Random random(33);
  Points x = Vector3(0.0, 1.0, 0.1);
  Index squeezed = 0;
  for (int step = 0; step < 1000; ++step) {
    Points after = x + 0.5 * random.direction() - 0.3 * Vector3::UnitY();
    environment.truncate(x, after, {0}, squeezed);
    ASSERT_EQ(squeezed, 0);
    for (Index k = 0; k < 2; ++k) {
      const RigidTransform into = environment.pose_after(k).inverse();
      ASSERT_FALSE(crosses(*std::get<MeshGeometry>(left.geometry).mesh, into * x.col(0), into * after.col(0)));
    }
    x = after;
  }
}

}  // namespace
}  // namespace sprung
