// Obstacles that move, into cloths and under them.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung::testing {
namespace {

class Moving : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, Moving, ::testing::Values(1.0, 4.0));

TEST_P(Moving, ABallShotAtAHangingClothPushesIt) {
  const ScenarioReport report =
      run_scenario(load_scenario("hanging_cloth", {}, GetParam()), [](const Simulator& simulator, const FrameDiagnostics& frame) {
        // At this time the ball has passed the plane in which the cloth hung, but not far enough for the cloth to slip off.
        if (frame.time < 0.16 || frame.time > 0.17) return;
        const double front = 1.0 - 20.0 * (frame.time - 0.1) - 0.12;
        EXPECT_LT(simulator.positions().row(2).minCoeff(), front) << "at " << frame.time << " s";
      });
  EXPECT_TRUE(report.is_free()) << report;
}

// The plate's acceleration stays below 0.5 g, so that friction can make the cloth follow.
TEST_P(Moving, AClothDoesNotSlipOnARisingRotatingPlate) {
  Points start;
  double slip = 0.0;
  const Watch watch = [&](const Simulator& simulator, const FrameDiagnostics& frame) {
    const Obstacle& plate = simulator.obstacles().front();
    const Points on_plate = plate.motion.pose(plate.rest_pose, frame.time).inverse() * simulator.positions();
    if (frame.frame == 1) start = on_plate;
    slip = std::max(slip, (on_plate - start).colwise().norm().maxCoeff());
  };
  const ScenarioReport report = run_scenario(load_scenario("cloth_on_plate", {}, GetParam()), watch);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_LT(slip, 1e-9);
}

}  // namespace
}  // namespace sprung::testing
