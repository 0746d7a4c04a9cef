// Surfaces that cells carry: the surface is judged, not the cells.
#include "scenarios/scenario.h"

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

// The spike moves up by 1.5 m at 15 m/s.
TEST_P(LatticeScenario, ASpikeIsShotAtABall) {
  const char* const shot = R"(obstacles.spike.motion={"keyframes": [{"time": 0}, {"time": 0.1, "position": [0, 1.5, 0]}]})";
  const ScenarioReport report = run_scenario(load_scenario("lattice_on_spike", {shot, "duration=0.3"}, 1.0 / GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
}

}  // namespace
}  // namespace sprung::testing
