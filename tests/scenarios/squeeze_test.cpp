// Networks between obstacles that close in on them.
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

namespace sprung::testing {
namespace {

class Squeeze : public ::testing::TestWithParam<double> {};

// A jelly's step is as long as its springs allow: there is none that is four times coarser, but one that is finer.
INSTANTIATE_TEST_SUITE_P(StepFactor, Squeeze, ::testing::Values(0.25, 1.0));

TEST_P(Squeeze, AJellyBetweenPlatesClosingToHalfItsHeight) {
  double height = 0.0;
  const ScenarioReport report =
      run_scenario(load_scenario("squeezed_jelly", {}, GetParam()), [&](const Simulator& simulator, const FrameDiagnostics&) {
        height = simulator.positions().row(1).maxCoeff() - simulator.positions().row(1).minCoeff();
      });
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.squeezed, 0);
  // The plates end 0.11 m apart and each keeps the thickness of 5 mm.
  EXPECT_NEAR(height, 0.1, 0.05 * 0.005);
}

}  // namespace
}  // namespace sprung::testing
