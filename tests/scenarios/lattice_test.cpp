// Surfaces that cells carry: the surface is judged, not the cells.
#include "scenarios/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung::testing {
namespace {

class LatticeScenario : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, LatticeScenario, ::testing::Values(1.0, 4.0));

TEST_P(LatticeScenario, ABallFallsOnASpike) {
  const ScenarioReport report = run_scenario(load_stiff_scenario("lattice_on_spike", GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

TEST_P(LatticeScenario, ABallIsThrownAtASpike) {
  const char* const thrown = "bodies.ball.velocity=[0, -20, 0]";
  const ScenarioReport report = run_scenario(load_scenario("lattice_on_spike", {thrown, "duration=0.3"}, 1.0 / GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
}

// Corners of cells lie outside of the ball, and so below the ground when the ball lies on it.
TEST(LatticeAtRest, ItsSurfaceLiesOnTheGroundAndItsCellsDoNotCollide) {
  const char* const ground = R"(obstacles={"ground": {"shape": {"type": "half_space"}, "friction": 0.3}})";
  const char* const low = R"(bodies.ball.place={"position": [0, 0.16, 0], "rotation": [45, 0, 45]})";
  for (const char* const contact :
       {R"(contact={"response": "projection"})", R"(contact={"response": "penalty", "stiffness": 500, "damping": 1})"}) {
    const BuiltScene scene = load_scenario("lattice_on_spike", {ground, low, contact});
    Simulator simulator(scene.network, scene.settings, scene.obstacles);
    EXPECT_THAT(simulator.warnings(), ::testing::Each(::testing::HasSubstr("static_friction has no effect with penalty contact")));
    const Body& ball = simulator.network().bodies[0];
    while (simulator.time() < 1.0) simulator.step();
    const auto vertices = simulator.positions().leftCols(ball.vertex_count());
    const auto corners = simulator.positions().rightCols(ball.particle_count - ball.vertex_count());
    EXPECT_LT(vertices.row(1).minCoeff(), 1.1 * ball.material.thickness) << "on the ground, at the thickness or below it";
    EXPECT_LT(corners.row(1).minCoeff(), 0.0) << "a cell is 0.05 m wide";
    EXPECT_GT(simulator.contact_count(), 0);
    EXPECT_LT(simulator.contact_particles().back(), ball.vertex_count());
  }
}

// A surface that moved alone would be pulled back by its cells at once, with tens of joules.
TEST(LatticeAtTheStart, PushOutMovesItAsAWhole) {
  const char* const ground = R"(obstacles={"ground": {"shape": {"type": "half_space"}, "friction": 0.3}})";
  const BuiltScene scene = load_scenario(
      "lattice_on_spike", {ground, R"(bodies.ball.place={"position": [0, 0.05, 0]})", R"(contact={"start": "push_out"})"});
  Simulator simulator(scene.network, scene.settings, scene.obstacles);
  const Points moved = simulator.positions() - scene.network.positions;
  EXPECT_GT(moved(1, 0), 0.1);
  EXPECT_LT((moved.colwise() - moved.col(0)).cwiseAbs().maxCoeff(), 1.0e-12);
  const double weight = scene.network.masses.sum() * 9.81;
  simulator.step();
  EXPECT_LT(kinetic_energy(simulator), weight * 1.0e-3) << "less than from a fall by a millimetre";
}

// The spike moves up by 1.5 m at 15 m/s.
TEST_P(LatticeScenario, ASpikeIsShotAtABall) {
  const char* const shot = R"(obstacles.spike.motion={"keyframes": [{"time": 0}, {"time": 0.1, "position": [0, 1.5, 0]}]})";
  const ScenarioReport report = run_scenario(load_scenario("lattice_on_spike", {shot, "duration=0.3"}, 1.0 / GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
}

}  // namespace
}  // namespace sprung::testing
