// Networks compressed between obstacles, or hit by an obstacle at a pin.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace sprung::testing {
namespace {

class JellyBetweenPlates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, JellyBetweenPlates, ::testing::Values(0.25, 1.0, 4.0));

TEST_P(JellyBetweenPlates, IsCompressedToHalfItsHeight) {
  double height = 0.0;
  const ScenarioReport report =
      run_scenario(load_stiff_scenario("squeezed_jelly", GetParam()), [&](const Simulator& simulator, const FrameDiagnostics&) {
        height = simulator.positions().row(1).maxCoeff() - simulator.positions().row(1).minCoeff();
      });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
  // The plates end 0.11 m apart, and the jelly keeps its thickness of 5 mm from each.
  EXPECT_NEAR(height, 0.1, 0.05 * 0.005);
}

struct Press {
  ScenarioReport report;
  double fastest = 0.0;  ///< [m/s]
};

/// Two plates close on a cloth at 0.2 m/s until they are `gap` [m] apart, or overlap if `gap` is negative, and open again.
Press press(double gap, double step_factor) {
  const std::string closed = json_text({0.0, gap - 0.1, 0.0});
  std::string plate = R"(obstacles.upper={"shape": {"type": "box", "size": [1, 0.1, 1]}, "place": {"position": [0, 0.2, 0]},)";
  plate.append(R"("motion": {"keyframes": [{"time": 0}, {"time": 0.5, "position": )").append(closed);
  plate.append(R"(}, {"time": 0.7, "position": )").append(closed).append(R"(}, {"time": 1.2}]}})");
  Press result;
  const Watch watch = [&](const Simulator& simulator, const FrameDiagnostics& /*frame*/) {
    result.fastest = std::max(result.fastest, simulator.state().v.colwise().norm().maxCoeff());
  };
  result.report = run_scenario(load_scenario("cloth_on_plate", {plate, "obstacles.plate.motion={}"}, step_factor), watch);
  return result;
}

class ClothBetweenPlates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, ClothBetweenPlates, ::testing::Values(1.0, 4.0));

TEST_P(ClothBetweenPlates, StaysFreeInLessThanItsThickness) {
  for (const double gap : {0.009, 0.005, 0.001}) {
    const Press pressed = press(gap, GetParam());
    EXPECT_TRUE(pressed.report.is_free()) << "plates " << gap << " m apart: " << pressed.report;
    EXPECT_EQ(pressed.report.infeasible, 0);
    EXPECT_LT(pressed.fastest, 0.5) << "of the order of the plate's speed";
  }
}

TEST_P(ClothBetweenPlates, IsReportedWhereThereIsNoRoomAndFreeAgainAfterwards) {
  const Press pressed = press(-0.01, GetParam());
  EXPECT_FALSE(pressed.report.is_free()) << pressed.report;
  EXPECT_GT(pressed.report.infeasible, 0);
  EXPECT_LT(pressed.report.last_wrong_frame, 0.5 * pressed.report.frames) << pressed.report;
  EXPECT_LT(pressed.fastest, 0.5) << "of the order of the plate's speed";
}

// A pin follows its own motion, even where an obstacle passes over it.
class PinInTheBallsPath : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, PinInTheBallsPath, ::testing::Values(1.0, 4.0));

TEST_P(PinInTheBallsPath, TheClothBecomesFreeAgain) {
  double stretch = 0.0;
  const ScenarioReport report =
      run_scenario(load_scenario("hanging_cloth", {"obstacles.ball.place.position=[0.5, 0.5, 1]"}, GetParam()),
                   [&](const Simulator&, const FrameDiagnostics& frame) { stretch = frame.max_stretch; });
  EXPECT_FALSE(report.is_free()) << report;
  EXPECT_GT(report.infeasible, 0) << "it is reported";
  EXPECT_LT(report.last_wrong_frame, 0.2 * report.frames) << report;
  EXPECT_LT(stretch, 0.2) << "at the end; a ball of 0.12 m that is stuck stretches a spring of 0.04 m by more than its length";
}

TEST_P(PinInTheBallsPath, TheClothAroundThePinIsNotDraggedAlong) {
  double stretch = 0.0;
  const ScenarioReport report =
      run_scenario(load_scenario("hanging_cloth", {R"(bodies.cloth.pins=[{"nearest": [0.03, 0.05, 0]}])"}, GetParam()),
                   [&](const Simulator&, const FrameDiagnostics& frame) { stretch = frame.max_stretch; });
  EXPECT_FALSE(report.is_free()) << report;
  EXPECT_GT(report.infeasible, 0) << "it is reported";
  EXPECT_LT(report.last_wrong_frame, 0.2 * report.frames) << report;
  // The ball passes in 0.1 s, in which it moves 50 times as far as a spring is long. Measured: 0.2 and 2.0, in steps of 1/240 s and
  // four times as long.
  EXPECT_LT(report.max_stretch, 3.0) << report;
  EXPECT_LT(stretch, 0.1) << "at the end";
}

}  // namespace
}  // namespace sprung::testing
