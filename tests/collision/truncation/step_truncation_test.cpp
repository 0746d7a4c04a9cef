// No particle crosses a surface, checked by exact predicates over all triangles.
#include "collision/sample_meshes.h"
#include "collision/self_networks.h"
#include "collision/single_particles.h"
#include "geometry/queries/side_of_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

using test::Random;

/// The number of triangles that a ray upward from p crosses. The ray is tilted a little, since particles come to rest above edges.
int triangles_above(const TriangleMesh& mesh, const Vector3& p) {
  int crossed = 0;
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3 a = mesh.vertices.col(mesh.triangles(0, t));
    const Vector3 b = mesh.vertices.col(mesh.triangles(1, t));
    const Vector3 c = mesh.vertices.col(mesh.triangles(2, t));
    const Vector3 far = p + 100.0 * Vector3(0.00317, 1.0, 0.00129);
    if ((side_of_plane(a, b, c, p) > 0.0) == (side_of_plane(a, b, c, far) > 0.0)) continue;
    const bool first = side_of_plane(p, far, a, b) > 0.0;
    if (first == (side_of_plane(p, far, b, c) > 0.0) && first == (side_of_plane(p, far, c, a) > 0.0)) ++crossed;
  }
  return crossed;
}

Obstacle mesh_obstacle(const TriangleMesh& mesh, bool closed) {
  Obstacle result;
  result.name = "mesh";
  result.geometry = MeshGeometry{std::make_shared<const TriangleMesh>(mesh), closed};
  return result;
}

/// Moves particles at random around an obstacle, within `range` of its centre in its own frame. Each has to stay on its side: below
/// or above an open mesh, outside of a closed one.
void expect_no_crossing(const Obstacle& obstacle, Index count, int steps, double kick, double range) {
  const ObstacleSet obstacles({obstacle});
  const TriangleMesh& mesh = *std::get<MeshGeometry>(obstacle.geometry).mesh;
  const bool closed = std::get<MeshGeometry>(obstacle.geometry).closed;
  const auto within = [range](const Vector3& p) { return Vector3(p.cwiseMax(-range).cwiseMin(range)); };
  Random random(31);
  Points x(3, count);
  std::vector<bool> odd(static_cast<std::size_t>(count));
  const RigidTransform start = obstacle.motion.pose(obstacle.rest_pose, 0.0);
  for (Index i = 0; i < count; ++i) {
    Vector3 p = within(test::near_surface(mesh, random, 0.2));
    while (closed && triangles_above(mesh, p) % 2 == 1) p = within(test::near_surface(mesh, random, 0.3));
    odd[static_cast<std::size_t>(i)] = triangles_above(mesh, p) % 2 == 1;
    x.col(i) = start * p;
  }
  StepTruncation truncation = test::single_particles(obstacles, count);
  Index stopped = 0;
  for (int step = 0; step < steps; ++step) {
    const ObstacleFrame frame(obstacles, 0.01 * step, 0.01 * (step + 1));
    const RigidTransform& pose = frame.after(0);
    Points after = x;
    for (Index i = 0; i < count; ++i) {
      // Most move straight towards a vertex and beyond.
      const Vector3 target = pose * mesh.vertices.col(random.below(static_cast<Index>(mesh.vertices.cols())));
      const Vector3 at = target - x.col(i);
      after.col(i) += i % 3 == 0 ? Vector3(kick * random.direction()) : Vector3(random.between(0.0, 2.0) * at);
      after.col(i) = pose * within(pose.inverse() * after.col(i));
    }
    const TruncationResult result = truncation.truncate(frame, x, after);
    stopped += result.truncated;
    ASSERT_EQ(result.infeasible, 0);
    for (Index i = 0; i < count; ++i) {
      ASSERT_EQ(triangles_above(mesh, pose.inverse() * after.col(i)) % 2 == 1, odd[static_cast<std::size_t>(i)])
          << "particle " << i << " in step " << step;
    }
    x = after;
  }
  EXPECT_GT(stopped, count);
}

TEST(StepTruncation, NothingPassesAClosedMesh) {
  expect_no_crossing(mesh_obstacle(test::torus(1.0, 0.3, 20, 10), true), 200, 40, 1.0, 10.0);
}

TEST(StepTruncation, NothingPassesNeedles) { expect_no_crossing(mesh_obstacle(test::needles(12), true), 200, 40, 0.5, 10.0); }

TEST(StepTruncation, NothingPassesAnOpenMesh) {
  expect_no_crossing(mesh_obstacle(test::terrain(24, [](Index i, Index j) { return 0.3 * ((i + 2 * j) % 3); }), false), 200, 40,
                     1.0, 2.9);
}

TEST(StepTruncation, NothingPassesARotatingMesh) {
  Obstacle wheel = mesh_obstacle(test::torus(1.0, 0.3, 20, 10), true);
  wheel.motion.spin = Vector3(400.0, 900.0, -300.0);
  wheel.motion.keyframes = {{0.0}, {0.2, Vector3(4.0, 0.0, 0.0)}, {0.4}};
  expect_no_crossing(wheel, 200, 40, 0.5, 10.0);
}

/// Moves each particle of a cloth and of ropes at random around a mesh, most of them little and some straight at it. No element may
/// cross the mesh.
void expect_no_element_crosses(const TriangleMesh& mesh, bool closed, int steps) {
  test::SelfNetwork network;
  network.add_cloth(8, Vector3(-1.2, 1.2, -1.2), Vector3(0.3, 0.0, 0.0), Vector3(0.0, 0.0, 0.3));
  for (const double z : {-1.5, 1.5}) network.add_rope(8, Vector3(-1.2, 0.0, z), Vector3(0.3, 0.0, 0.0));
  const Index count = network.count();
  const std::vector<char> alone(static_cast<std::size_t>(network.bodies), 0);
  const ObstacleSet obstacles({mesh_obstacle(mesh, closed)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  StepTruncation truncation(obstacles,
                            make_collision_surface(network.elements, network.positions, network.body_of, Scalars::Zero(count),
                                                   network.motions, alone, alone),
                            network.positions, 0.0);
  auto crossings = [&, everything = Points(3, count + mesh.vertices.cols())](const Points& positions) mutable {
    everything << positions, mesh.vertices;
    int found = 0;
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      const Element face{{count + mesh.triangles(0, t), count + mesh.triangles(1, t), count + mesh.triangles(2, t)}, 3};
      for (const Element& element : network.elements) {
        found += test::count_crossings(element, face, everything) + test::count_crossings(face, element, everything);
      }
    }
    return found;
  };
  Random random(73);
  Points x = network.positions;
  Index stopped = 0;
  for (int step = 0; step < steps; ++step) {
    Points after = x;
    for (Index i = 0; i < count; ++i) {
      const Vector3 at = mesh.vertices.col(random.below(static_cast<Index>(mesh.vertices.cols())));
      const bool far = random.below(8) == 0;
      after.col(i) += far ? Vector3(random.between(0.0, 1.5) * (at - x.col(i))) : Vector3(0.01 * random.direction());
    }
    const TruncationResult result = truncation.truncate(frame, x, after);
    stopped += result.truncated;
    ASSERT_EQ(result.infeasible, 0);
    ASSERT_EQ(crossings(after), 0) << "in step " << step;
    x = after;
  }
  EXPECT_GT(stopped, count);
}

TEST(StepTruncation, NoElementCrossesNeedles) { expect_no_element_crosses(test::needles(12), true, 300); }

TEST(StepTruncation, NoElementCrossesARing) { expect_no_element_crosses(test::torus(0.8, 0.1, 16, 6), true, 300); }

TEST(StepTruncation, AThinSheetStopsParticlesAt500MetresPerSecondFromEitherSide) {
  const ObstacleSet obstacles({mesh_obstacle(test::flat_sheet(4), false)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  constexpr double kMove = 500.0 / 60.0;
  Points before(3, 4);
  before << 0.3, 0.3, 0.0, 0.5, 0.01, -0.01, 0.01, -0.01, 0.4, 0.4, 0.0, 0.5;  // the last two over a vertex and an edge
  Points after = before;
  after.row(1) -= Eigen::RowVector4d(kMove, -kMove, kMove, -kMove);
  const TruncationResult result = test::single_particles(obstacles, 4).truncate(frame, before, after);
  EXPECT_EQ(result.truncated, 4);
  EXPECT_EQ(result.infeasible, 0);
  for (Index i = 0; i < 4; ++i) EXPECT_GT(after(1, i) * before(1, i), 0.0) << i;
}

TEST(StepTruncation, AParticlePressedForLongStaysInFront) {
  const ObstacleSet obstacles({mesh_obstacle(test::flat_sheet(4), false)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  StepTruncation truncation = test::single_particles(obstacles, 1);
  Points x = Vector3(0.3, 0.01, 0.4);
  for (int step = 0; step < 10000; ++step) {
    Points after = x;
    after(1, 0) -= 0.05;
    after(0, 0) += 0.01 * ((step / 50) % 2 == 0 ? 1 : -1);
    ASSERT_EQ(truncation.truncate(frame, x, after).infeasible, 0);
    x = after;
    ASSERT_GT(x(1, 0), 0.0) << step;
  }
}

TEST(StepTruncation, RelaxMovesStoppedParticlesFromTheirSafePositions) {
  const ObstacleSet obstacles({mesh_obstacle(test::flat_sheet(4), false)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  StepTruncation truncation = test::single_particles(obstacles, 2);
  Points before(3, 2);
  before << 0.3, -0.3, 0.01, 0.5, 0.4, 0.4;
  Points after = before;
  after(1, 0) = -1.0;
  int times = 0;
  const auto relax = [&](Points& x) {
    EXPECT_GT(x(1, 0), 0.0);
    if (times++ < 3) x.col(0) += Vector3(0.0, -1.0, 0.0);
    if (times == 3) x.col(1) = Vector3(-0.3, -0.5, 0.4);
    if (times == 4) x.col(0) = Vector3(0.5, 0.5, 0.4);
    return times <= 4;
  };
  const TruncationResult result = truncation.truncate(frame, before, after, relax);
  EXPECT_EQ(times, 5);
  EXPECT_EQ(result.truncated, 0);
  EXPECT_EQ(after.col(0), Vector3(0.5, 0.5, 0.4));
  EXPECT_GT(after(1, 1), 0.0) << "the second particle crossed the sheet after the first was stopped";
}

TEST(StepTruncation, RelaxIsNotCalledIfNothingIsStopped) {
  const ObstacleSet obstacles({mesh_obstacle(test::flat_sheet(4), false)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  Points after = Vector3(0.3, 0.02, 0.4);
  test::single_particles(obstacles, 1).truncate(frame, Vector3(0.3, 0.01, 0.4), after, [](Points&) {
    ADD_FAILURE() << "nothing was stopped";
    return false;
  });
  EXPECT_EQ(after, Vector3(0.3, 0.02, 0.4));
}

TEST(StepTruncation, AnApproachingObstacleMovesARestingParticle) {
  Obstacle sheet = mesh_obstacle(test::flat_sheet(4), false);
  sheet.rest_pose.translation() = Vector3(0.0, -1.0, 0.0);
  sheet.motion.keyframes = {{0.0}, {0.1, Vector3(0.0, 50.0, 0.0)}};
  const ObstacleSet obstacles({sheet});
  const ObstacleFrame frame(obstacles, 0.0, 0.1);
  const Points rest = Vector3(0.1, 0.0, 0.2);
  Points after = rest;
  const TruncationResult result = test::single_particles(obstacles, 1).truncate(frame, rest, after);
  EXPECT_EQ(result.truncated, 1);
  EXPECT_EQ(result.infeasible, 0);
  EXPECT_GT(after(1, 0), 49.0);
  EXPECT_LT(after(1, 0), 50.0);
}

TEST(StepTruncation, PinnedAndFreeParticlesKeepEveryBit) {
  const ObstacleSet obstacles({mesh_obstacle(test::flat_sheet(4), false)});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  Points before(3, 2);
  before << 0.3, 0.3, 1.0, 1.0, 0.4, 0.4;
  Points after = before;
  after(1, 0) = -1.0;
  after(1, 1) = 0.1 / 3.0;
  const Points wanted = after;
  EXPECT_EQ(
      test::single_particles(obstacles, {ParticleMotion::driven, ParticleMotion::free}).truncate(frame, before, after).truncated,
      0);
  EXPECT_EQ(after, wanted);
}

TEST(StepTruncation, ReportsAParticleBetweenObstaclesThatPassEachOther) {
  Obstacle upper = mesh_obstacle(test::flat_sheet(4), false);
  Obstacle lower = upper;
  upper.rest_pose.translation() = Vector3(0.0, 1.0, 0.0);
  lower.rest_pose.translation() = Vector3(0.0, -1.0, 0.0);
  upper.motion.keyframes = {{0.0}, {1.0, Vector3(0.0, -1.5, 0.0)}};
  lower.motion.keyframes = {{0.0}, {1.0, Vector3(0.0, 1.5, 0.0)}};
  const ObstacleSet obstacles({upper, lower});
  const ObstacleFrame frame(obstacles, 0.0, 1.0);
  const Points rest = Vector3(0.1, 0.0, 0.2);
  Points after = rest;
  const TruncationResult result = test::single_particles(obstacles, 1).truncate(frame, rest, after);
  EXPECT_EQ(result.truncated, 1);
  EXPECT_EQ(result.infeasible, 1);
}

/// A sheet that deforms to `deform(position)` within one second.
template <class Deform>
Obstacle deforming_obstacle(const TriangleMesh& mesh, const Deform& deform) {
  MeshSequence sequence{.triangles = mesh.triangles, .frames = {mesh.vertices, mesh.vertices}, .frame_rate = 1.0};
  for (Index i = 0; i < mesh.vertices.cols(); ++i) sequence.frames[1].col(i) = deform(Vector3(mesh.vertices.col(i)));
  return {.name = "mesh", .geometry = SequenceGeometry{std::make_shared<const MeshSequence>(std::move(sequence)), false}};
}

// The surface rotates by 45 degrees in one step: no plane above it at the begin is above it at the end.
TEST(StepTruncation, ParticlesMoveWithARotatingSurface) {
  const ObstacleSet obstacles(
      {deforming_obstacle(test::flat_sheet(8), [](const Vector3& x) { return Vector3(x.x(), x.x() + 0.1 * x.z(), x.z()); })});
  const ObstacleFrame frame(obstacles, 0.0, 1.0);
  constexpr Index kCount = 100;
  Random random(35);
  Points rest(3, kCount);
  for (auto&& p : rest.colwise()) {
    p = random.in_box({Vector3(-0.9, 0.0, -0.9), Vector3(0.9, 0.0, 0.9)}) +
        std::exp2(-20.0 * random.between(0.1, 1.0)) * Vector3::UnitY();
  }
  Points after = rest;
  EXPECT_EQ(test::single_particles(obstacles, kCount).truncate(frame, rest, after).infeasible, 0);
  for (const auto& p : after.colwise()) EXPECT_GT(p.y(), p.x() + 0.1 * p.z());
}

// In one step the upper sheet moves below the particle's start position.
TEST(StepTruncation, ParticlesStayBetweenSheetsOfOneMesh) {
  const TriangleMesh sheet = test::flat_sheet(4);
  const Eigen::Index vertices = sheet.vertices.cols();
  TriangleMesh sheets{Points(3, 2 * vertices), Triangles(3, 2 * sheet.triangles.cols())};
  sheets.vertices << sheet.vertices, sheet.vertices.colwise() + Vector3::UnitY();
  sheets.triangles << sheet.triangles, (sheet.triangles.array() + static_cast<Index>(vertices)).matrix();
  const ObstacleSet obstacles({deforming_obstacle(sheets, [](const Vector3& x) { return Vector3(x.x(), 0.2 * x.y(), x.z()); })});
  const ObstacleFrame frame(obstacles, 0.0, 1.0);
  const Points rest = Vector3(0.1, 0.4, 0.2);
  Points after = rest;
  EXPECT_EQ(test::single_particles(obstacles, 1).truncate(frame, rest, after).infeasible, 0);
  EXPECT_GT(after(1, 0), 0.0);
  EXPECT_LT(after(1, 0), 0.2);
}

TEST(StepTruncation, ReportsAnElementThatAPinPullsThroughAnObstacleInTheSameStep) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.2}};
  ball.rest_pose.translation() = Vector3(-1.0, 0.0, 0.0);
  ball.motion.keyframes = {{0.0}, {1.0, Vector3(1.0, 0.0, 0.0)}, {2.0, Vector3(1.0, 1.0, 0.0)}};
  const ObstacleSet obstacles({ball});
  test::SelfNetwork segment;
  segment.add_rope(1, Vector3::Zero(), Vector3(0.6, 0.0, 0.0));
  segment.motions[0] = ParticleMotion::driven;
  StepTruncation truncation(
      obstacles,
      make_collision_surface(segment.elements, segment.positions, segment.body_of, Scalars::Zero(2), segment.motions, {0}, {0}),
      segment.positions, 0.0);
  const auto infeasible_until = [&](double time) {
    const ObstacleFrame frame(obstacles, time - 1.0, time);
    Points after = segment.positions;
    return truncation.truncate(frame, segment.positions, after).infeasible;
  };
  EXPECT_EQ(infeasible_until(1.0), 2) << "both ends of the segment that the ball crosses";
  infeasible_until(2.0);
  EXPECT_EQ(infeasible_until(3.0), 0) << "the ball has left the segment";
}

TEST(StepTruncation, AParticleInAWedgeOfTwoObstaclesIsNeverInfeasible) {
  Obstacle left = mesh_obstacle(test::flat_sheet(8), false);
  Obstacle right = left;
  left.rest_pose.linear() = rotation_from_degrees(Vector3(0.0, 0.0, -60.0));
  right.rest_pose.linear() = rotation_from_degrees(Vector3(0.0, 0.0, 60.0));
  const ObstacleSet obstacles({left, right});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  Random random(33);
  StepTruncation truncation = test::single_particles(obstacles, 1);
  Points x = Vector3(0.0, 1.0, 0.1);
  for (int step = 0; step < 1000; ++step) {
    Points after = x + 0.5 * random.direction() - 0.3 * Vector3::UnitY();
    after(2, 0) = std::clamp(after(2, 0), -1.0, 1.0);
    ASSERT_EQ(truncation.truncate(frame, x, after).infeasible, 0);
    for (Index k = 0; k < 2; ++k) {
      ASSERT_GT((frame.after(k).inverse() * after.col(0)).y(), 0.0) << step;
    }
    x = after;
  }
}

}  // namespace
}  // namespace sprung
