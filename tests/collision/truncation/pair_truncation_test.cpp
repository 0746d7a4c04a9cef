// Bodies between an obstacle and each other are never infeasible and never cross, checked by exact predicates.
#include "collision/self_networks.h"
#include "collision/truncation/step_truncation.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

namespace sprung {
namespace {

using test::Random;
using test::SelfNetwork;

constexpr double kEdge = 0.01;
constexpr double kMargin = 0.001;
const Vector3 kX = Vector3::UnitX();
const Vector3 kZ = Vector3::UnitZ();

Obstacle torus(const Motion& motion) {
  const auto mesh = std::make_shared<const TriangleMesh>(test::torus(0.02, 0.006, 12, 8));
  return {.name = "torus", .geometry = MeshGeometry{mesh, true}, .motion = motion};
}

/// The torus under random affine maps with entries of up to `strain`, ten frames a second.
Obstacle deforming_torus(double strain, const Motion& motion) {
  const TriangleMesh mesh = test::torus(0.02, 0.006, 12, 8);
  Random random(6);
  MeshSequence sequence{.triangles = mesh.triangles, .frames = {mesh.vertices}, .frame_rate = 10.0, .loop = true};
  for (int frame = 0; frame < 4; ++frame) {
    Matrix3 map = Matrix3::Identity();
    for (double& entry : map.reshaped()) entry += random.between(-strain, strain);
    sequence.frames.push_back(map * mesh.vertices);
  }
  return {.name = "torus",
          .geometry = SequenceGeometry{std::make_shared<const MeshSequence>(std::move(sequence)), true},
          .motion = motion};
}

/// The number of edges that cross a triangle of the other, in both directions.
int count_crossings(const std::vector<Element>& elements, const Points& x, const TriangleMesh& mesh) {
  int crossings = 0;
  for (const Element& element : elements) {
    const int corners = element.corners;
    std::array<Vector3, 3> own;
    for (int k = 0; k < corners; ++k) own[static_cast<std::size_t>(k)] = x.col(element.particles[static_cast<std::size_t>(k)]);
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      std::array<Vector3, 3> other;
      for (Index k = 0; k < 3; ++k) other[static_cast<std::size_t>(k)] = mesh.vertices.col(mesh.triangles(k, t));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const bool has_edge = corners == 3 || (corners == 2 && k == 0);
        if (has_edge && test::segment_meets_triangle(own[k], own[next], other[0], other[1], other[2])) ++crossings;
        if (corners == 3 && test::segment_meets_triangle(other[k], other[next], own[0], own[1], own[2])) ++crossings;
      }
    }
  }
  return crossings;
}

/// A pile of two cloths and a rope that is pulled into the hole of a torus, with random displacements of up to `kick` [m] a step.
void expect_feasible(const Obstacle& obstacle, double kick, std::uint64_t seed) {
  SelfNetwork network;
  network.add_cloth(5, {-0.025, 0.012, -0.025}, kEdge * kX, kEdge * kZ);
  network.add_cloth(5, {-0.024, 0.016, -0.026}, kEdge * kX, kEdge * kZ);
  network.add_rope(6, {-0.03, 0.02, 0.001}, kEdge * kX);
  const ObstacleSet obstacles({obstacle});
  StepTruncation truncation(obstacles, network.surface(0.0), network.positions, kMargin);
  Random random(seed);
  Points x = network.positions;
  for (int step = 0; step < 30; ++step) {
    const ObstacleFrame frame(obstacles, 0.01 * step, 0.01 * (step + 1));
    const RigidTransform& pose = frame.after(0);
    Points after = x;
    for (auto p : after.colwise()) p += random.between(0.0, kick) * random.direction() + 0.3 * (pose.translation() - p);
    truncation.begin_step(frame, x, after);
    EXPECT_EQ(truncation.truncate(frame, x, after).infeasible, 0) << "step " << step;
    ASSERT_EQ(test::count_crossings(network.elements, after), 0) << "step " << step;
    ASSERT_EQ(count_crossings(network.elements, pose.inverse() * after, obstacle_mesh(obstacle.geometry, 0.0, 0.01 * (step + 1))),
              0)
        << "step " << step;
    x = after;
  }
}

Motion motion_to(const Vector3& position, const Vector3& rotation) {
  return {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = position, .rotation = rotation}}};
}

TEST(PairTruncation, FindsAdmissiblePositionsOnARestingObstacle) {
  for (const double kick : {0.002, 0.02}) expect_feasible(torus({}), kick, 1);
}

// 1 m/s is the length of an edge in a step.
TEST(PairTruncation, FindsAdmissiblePositionsOnAMovingObstacle) {
  for (const double speed : {0.3, 30.0}) expect_feasible(torus(motion_to({0.0, speed, 0.2 * speed}, Vector3::Zero())), 0.002, 2);
}

TEST(PairTruncation, FindsAdmissiblePositionsOnARotatingObstacle) {
  for (const double degrees : {100.0, 3000.0}) expect_feasible(torus(motion_to({0.0, 1.0, 0.0}, {degrees, 0.0, 0.0})), 0.002, 3);
}

TEST(PairTruncation, FindsAdmissiblePositionsOnADeformingObstacle) {
  for (const double strain : {0.05, 0.2})
    expect_feasible(deforming_torus(strain, motion_to({0.0, 0.3, 0.0}, {100.0, 0.0, 0.0})), 0.002, 4);
}

}  // namespace
}  // namespace sprung
