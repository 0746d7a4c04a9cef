// What obstacles and other elements leave no place together goes along with the obstacle, judged by exact predicates.
#include "collision/free_space.h"
#include "collision/self_networks.h"

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

Obstacle torus() {
  const auto mesh = std::make_shared<const TriangleMesh>(test::torus(0.02, 0.006, 12, 8));
  return {.name = "torus", .geometry = MeshGeometry{mesh, true}};
}

/// How many edges of the one meet triangles of the other, both ways.
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

/// A pile over a torus, drawn into its hole and thrown about by up to `kick` [m] a step, while the torus does one of `motions`.
void expect_free(const Motion& motion, double kick, std::uint64_t seed) {
  SelfNetwork network;
  network.add_cloth(5, {-0.025, 0.012, -0.025}, kEdge * kX, kEdge * kZ);
  network.add_cloth(5, {-0.024, 0.016, -0.026}, kEdge * kX, kEdge * kZ);
  network.add_rope(6, {-0.03, 0.02, 0.001}, kEdge * kX);
  Obstacle obstacle = torus();
  obstacle.motion = motion;
  const TriangleMesh& mesh = *std::get<MeshGeometry>(obstacle.geometry).mesh;
  Environment environment({obstacle});
  environment.set_interval(0.0, 0.0);
  FreeSpace space(environment, network.surface(0.0), network.positions, kMargin);
  Random random(seed);
  Points x = network.positions;
  for (int step = 0; step < 30; ++step) {
    environment.set_interval(0.01 * step, 0.01 * (step + 1));
    const RigidTransform& pose = environment.pose_after(0);
    Points after = x;
    for (auto p : after.colwise()) p += random.between(0.0, kick) * random.direction() + 0.3 * (pose.translation() - p);
    space.follow(x, after);
    EXPECT_EQ(space.truncate(x, after).squeezed, 0) << "step " << step;
    ASSERT_EQ(test::count_crossings(network.elements, after), 0) << "step " << step;
    ASSERT_EQ(count_crossings(network.elements, pose.inverse() * after, mesh), 0) << "step " << step;
    x = after;
  }
}

Motion motion_to(const Vector3& position, const Vector3& rotation) {
  return {.keyframes = {{.time = 0.0}, {.time = 1.0, .position = position, .rotation = rotation}}};
}

TEST(PairPlacement, FindsAPlaceForAllThatIsCaughtOnAnObstacleThatRests) {
  for (const double kick : {0.002, 0.02}) expect_free({}, kick, 1);
}

/// 1 m/s is an edge's length a step.
TEST(PairPlacement, FindsAPlaceForAllThatIsCaughtOnAnObstacleThatMoves) {
  for (const double speed : {0.3, 30.0}) expect_free(motion_to({0.0, speed, 0.2 * speed}, Vector3::Zero()), 0.002, 2);
}

TEST(PairPlacement, FindsAPlaceForAllThatIsCaughtOnAnObstacleThatTurns) {
  for (const double degrees : {100.0, 3000.0}) expect_free(motion_to({0.0, 1.0, 0.0}, {degrees, 0.0, 0.0}), 0.002, 3);
}

}  // namespace
}  // namespace sprung
