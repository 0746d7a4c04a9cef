// The handover of a stretch limit from passes to a global solve, and its effect.
#include "base/parallel.h"
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using Solver = StretchLimitSettings::Solver;

constexpr double kRate = 240.0;

/// At this rate these passes cannot keep the limit of a cloth with more than a few particles along a side.
StretchLimitSettings limit_of(Solver solver) {
  return {.max_stretch = 0.01, .iterations = 8, .tolerance = 0.005, .solver = solver};
}

/// A level cloth of 1 m without spring forces, pinned at two corners or free.
SpringNetwork limp_cloth(Index side, bool pinned, const ContactMaterial& material = {}) {
  SpringNetwork network = testing::cloth(side, 0.0, material);
  network.springs.stiffness.assign(network.springs.stiffness.size(), 0.0);
  network.springs.damping.assign(network.springs.damping.size(), 0.0);
  if (!pinned) return network;
  network.pins.push_back({.particles = {side * (side - 1), side * side - 1}, .origin = Vector3::Zero(), .motion = {}});
  for (const Index i : network.pins[0].particles) network.inverse_masses[i] = 0.0;
  return network;
}

Obstacle ball(double height, double radius) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = radius}};
  ball.rest_pose.translation() = Vector3(0.0, height, 0.0);
  return ball;
}

struct Outcome {
  Points x;
  double worst_excess = 0.0;  ///< in the last quarter of the steps
  std::optional<std::int64_t> solved_since;
  double nearest = 1.0;  ///< smallest distance from obstacles after any step [m]
};

Outcome run(const SpringNetwork& network, Solver solver, int steps, const std::vector<Obstacle>& obstacles = {},
            int max_substeps = 1) {
  Simulator simulator(network, {.step = 1.0 / kRate, .stretch_limit = limit_of(solver), .max_substeps = max_substeps}, obstacles);
  Outcome outcome;
  for (int step = 0; step < steps; ++step) {
    const StepReport report = simulator.step();
    if (step >= steps * 3 / 4) outcome.worst_excess = std::max(outcome.worst_excess, report.stretch_excess);
    outcome.nearest = std::min(outcome.nearest, simulator.obstacle_frame().min_distance(simulator.positions(), 1.0).value_or(1.0));
  }
  outcome.x = simulator.positions();
  outcome.solved_since = simulator.state().limit.handovers.front().solved_since;
  return outcome;
}

TEST(SolverTrial, ExcludesSolidsCompressionLimitsAndExplicitPasses) {
  BodyShape shape =
      make_solid({.size = {1.0, 1.0, 1.0}, .resolution = {3, 3, 3}}, {.structural = SpringMaterial{}, .shear = {}, .bend = {}});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("solid", shape);
  const SpringNetwork cloth = limp_cloth(4, true);
  StretchLimitSettings both_ways = limit_of(Solver::automatic);
  both_ways.max_compression = 0.5;
  EXPECT_TRUE(StretchLimit(cloth, limit_of(Solver::automatic)).may_be_handed_over(0));
  EXPECT_FALSE(StretchLimit(builder.build(), limit_of(Solver::automatic)).may_be_handed_over(0));
  EXPECT_FALSE(StretchLimit(cloth, both_ways).may_be_handed_over(0));
  EXPECT_FALSE(StretchLimit(cloth, limit_of(Solver::gauss_seidel)).may_be_handed_over(0));
  EXPECT_FALSE(StretchLimit(cloth, limit_of(Solver::automatic), {.may_collide = false}).may_be_handed_over(0))
      << "Newton solves it from the start";
}

TEST(SolverTrial, AutomaticEqualsNewtonWithoutContact) {
  const SpringNetwork cloth = limp_cloth(16, true);
  for (const int substeps : {1, 8}) {
    const Outcome automatic = run(cloth, Solver::automatic, 60, {}, substeps);
    EXPECT_EQ(automatic.x, run(cloth, Solver::newton, 60, {}, substeps).x);
    EXPECT_NE(automatic.x, run(cloth, Solver::gauss_seidel, 60, {}, substeps).x);
  }
}

TEST(SolverTrial, AutomaticEqualsPassesWhereTheySuffice) {
  const SpringNetwork cloth = limp_cloth(8, false, {.thickness = 0.01, .friction = 0.3, .static_friction = 0.3});
  const std::vector<Obstacle> below{ball(-0.32, 0.3)};
  const Outcome automatic = run(cloth, Solver::automatic, 120, below);
  EXPECT_FALSE(automatic.solved_since);
  EXPECT_EQ(automatic.x, run(cloth, Solver::gauss_seidel, 120, below).x);
  EXPECT_NE(automatic.x, run(cloth, Solver::newton, 120, below).x);
}

// A limp cloth that may touch itself falls over a post. Its layers stretch it, and a solve does not know them.
class ClothOverAPost : public ::testing::Test {
 protected:
  static Simulator simulator(Index side, Solver solver, int iterations, int substeps) {
    SpringNetwork network = limp_cloth(side, false, {.thickness = 0.005, .friction = 0.4, .static_friction = 0.4});
    network.bodies[0].contact.self = true;
    Obstacle post{.name = "post", .geometry = CylinderGeometry{.radius = 0.05, .height = 0.8}};
    post.rest_pose.translation() = Vector3(0.0, -0.45, 0.0);
    post.material = {.friction = 0.4, .static_friction = 0.4};
    const StretchLimitSettings limit{.max_stretch = 0.01, .iterations = iterations, .solver = solver};
    return Simulator(network, {.step = 1.0 / 60.0, .stretch_limit = limit, .max_substeps = substeps}, {post});
  }
};

TEST_F(ClothOverAPost, KeepsItsPassesWhereTheSolveIsNoBetter) {
  Simulator cloth = simulator(10, Solver::automatic, 1, 1);
  for (int step = 0; step < 60; ++step) {
    cloth.step();
    ASSERT_FALSE(cloth.state().limit.handovers[0].solved_since) << step;
  }
  EXPECT_GT(cloth.state().limit.handovers[0].patience, kFirstPatience) << "solves were tried";
}

TEST_F(ClothOverAPost, ComesBackToPassesAndTheirSubsteps) {
  Simulator cloth = simulator(14, Solver::automatic, 1, 8);
  const auto solved_since = [&] { return cloth.state().limit.handovers[0].solved_since; };
  for (int step = 0; step < 120 && !solved_since(); ++step) cloth.step();
  ASSERT_TRUE(solved_since());
  for (int step = 0; step < 120 && solved_since(); ++step) cloth.step();
  ASSERT_FALSE(solved_since());
  EXPECT_EQ(cloth.step().substeps, 8);
}

// A cloth that is pinned at two corners swings down over a ball and comes to hang across it. At this step size the passes would
// need many more iterations.
class ClothOverABall : public ::testing::Test {
 protected:
  static constexpr int kSteps = 300;
  const SpringNetwork cloth_ = limp_cloth(24, true, {.thickness = 0.01, .friction = 0.3, .static_friction = 0.3});
  const std::vector<Obstacle> ball_{ball(-0.45, 0.2)};
};

TEST_F(ClothOverABall, EndsWithinTheLimitThatPassesMissAndOutsideTheBall) {
  const Outcome passes = run(cloth_, Solver::gauss_seidel, kSteps, ball_);
  const Outcome automatic = run(cloth_, Solver::automatic, kSteps, ball_);
  EXPECT_FALSE(passes.solved_since);
  EXPECT_GT(passes.worst_excess, 0.05);
  ASSERT_TRUE(automatic.solved_since);
  EXPECT_LT(*automatic.solved_since, kSteps / 4);
  EXPECT_LT(automatic.worst_excess, wanted_excess(limit_of(Solver::automatic)));
  EXPECT_GT(automatic.nearest, 0.0);
}

TEST_F(ClothOverABall, DoesNotDependOnTheNumberOfThreads) {
  const auto positions = [&](int threads) {
    const ThreadLimit at_most(threads);
    return run(cloth_, Solver::automatic, kSteps / 3, ball_).x;
  };
  EXPECT_EQ(positions(1), positions(2));
}

// Passes use the largest number of substeps. The solve needs one while the cloth turns slowly.
TEST_F(ClothOverABall, NeedsNoSubstepsAfterTheHandover) {
  StretchLimitSettings limit = limit_of(Solver::automatic);
  limit.iterations = 1;
  Simulator simulator(cloth_, {.step = 1.0 / kRate, .stretch_limit = limit, .max_substeps = 4}, ball_);
  std::vector<int> substeps;
  for (int step = 0; step < 60; ++step) substeps.push_back(simulator.step().substeps);
  const auto since = simulator.state().limit.handovers.front().solved_since;
  ASSERT_TRUE(since);
  for (int step = 0; step <= *since; ++step) EXPECT_EQ(substeps[static_cast<std::size_t>(step)], 4) << step;
  EXPECT_EQ(substeps.back(), 1);
}

}  // namespace
}  // namespace sprung
