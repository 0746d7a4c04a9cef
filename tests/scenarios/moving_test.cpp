// Obstacles that move, into cloths and under them.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung::testing {
namespace {

class Moving : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, Moving, ::testing::Values(1.0, 4.0));

// The plate's acceleration stays below 0.5 g, so that friction can make the cloth follow.
TEST_P(Moving, ARisingTurningPlateCarriesAClothWithoutSlip) {
  Points start;
  double slip = 0.0;
  const Watch watch = [&](const Simulator& simulator, const FrameDiagnostics& frame) {
    const Obstacle& plate = simulator.environment().obstacles().front();
    const Points on_plate = plate.motion.pose(plate.placed, frame.time).inverse() * simulator.positions();
    if (frame.frame == 1) start = on_plate;
    slip = std::max(slip, (on_plate - start).colwise().norm().maxCoeff());
  };
  const ScenarioReport report = run_scenario(load_scenario("cloth_on_plate", {}, GetParam()), watch);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_LT(slip, 1e-9);
}

}  // namespace
}  // namespace sprung::testing
