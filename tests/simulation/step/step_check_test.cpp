#include "simulation/step/step_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The fastest mode has omega = 100 / s: symplectic Euler is stable up to 2 / omega = 0.02 s, and "auto" takes at most 0.9 of that;
/// without damping, resonance permits 0.01 s.
SpectralBounds bounds(double undamped) {
  SpectralBounds bounds;
  bounds.elastic = 1.0e4;
  bounds.undamped = undamped;
  bounds.strictest = "springs";
  return bounds;
}

SimulatorSettings settings(double step, double frame_rate, const IntegratorSettings& integrator = SymplecticEulerSettings{}) {
  SimulatorSettings settings;
  settings.step = step;
  settings.frame_rate = frame_rate;
  settings.integrator = integrator;
  settings.stability = StabilityCheck::warn;
  return settings;
}

StepFailure failure(const SimulatorSettings& settings, const SpectralBounds& bounds) {
  StepFailure failure;
  set_divergence_remedy(settings, bounds, failure);
  return failure;
}

TEST(StepCheck, AllMessagesNameTheSameStepWhichDividesAFrame) {
  const SpectralBounds damped = bounds(0.0);
  const SimulatorSettings too_large = settings(1.0 / 30.0, 30.0);
  EXPECT_THAT(unstable_step(too_large, damped).remedy, StartsWith("use a step of at most 0.0166 s, or \"auto\"; "));
  EXPECT_THAT(check_step(too_large, damped), ElementsAre(HasSubstr(" Use a step of at most 0.0166 s, or \"auto\".")));
  EXPECT_EQ(failure(too_large, damped).remedy, "use a step of at most 0.0166 s, or \"auto\"");
  EXPECT_EQ(failure(too_large, damped).smaller_step, 0.0166);
  EXPECT_EQ(failure(settings(0.0333, 0.0), damped).smaller_step, 0.018) << "without frames";
  EXPECT_EQ(failure(too_large, bounds(1.0e4)).smaller_step, 0.00833) << "0.01 does not divide a frame";
}

TEST(StepCheck, ADivergenceAtAStableStepAdvisesHalfOfIt) {
  const StepFailure found = failure(settings(1.0 / 90.0, 30.0), bounds(0.0));
  EXPECT_EQ(found.remedy, "use a step of at most 0.00555 s, less stiffness, or slower motion");
  EXPECT_EQ(found.smaller_step, 0.00555);
}

// Forces act in inner substeps, and a step that the user gives has none.
TEST(StepCheck, ADivergenceInInnerSubstepsAdvisesHalfOfThem) {
  SimulatorSettings inner = settings(1.0 / 30.0, 30.0);
  inner.inner_substeps = 3;
  EXPECT_EQ(failure(inner, bounds(0.0)).smaller_step, 0.00555);
}

TEST(StepCheck, ASchemeThatGainsEnergyIsNotAdvisedASmallerStepAlone) {
  const SpectralBounds damped = bounds(0.0);
  const SimulatorSettings small = settings(1.0 / 300.0, 30.0, ExplicitEulerSettings{});
  EXPECT_EQ(failure(small, damped).remedy, "explicit Euler gains energy at any step; use \"symplectic_euler\"");
  EXPECT_EQ(failure(small, damped).smaller_step, std::nullopt);
  const SimulatorSettings large = settings(1.0 / 30.0, 30.0, ExplicitEulerSettings{});
  EXPECT_THAT(unstable_step(large, damped).remedy,
              StartsWith("use \"symplectic_euler\" with a step of at most 0.0166 s or \"auto\"; "));
}

}  // namespace
}  // namespace sprung
