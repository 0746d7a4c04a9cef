// When an infeasible step is repeated.
#include "simulation/step/step_retry.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// The number of repeated steps out of `steps` steps that leave two particles infeasible. If `helps`, a repeated step leaves one.
int tries(int steps, bool helps, SimulationState& state) {
  int tried = 0;
  for (int step = 0; step < steps; ++step) {
    const bool again = may_retry(2, state);
    ++state.step;
    if (again) {
      ++tried;
      note_retry(2, helps ? 1 : 2, state);
    }
    note_step(2, state);
  }
  return tried;
}

TEST(StepRetry, FeasibleStepsAreNotRepeated) { EXPECT_FALSE(may_retry(0, {})); }

TEST(StepRetry, BecomesRarerWhileItDoesNotHelp) {
  const auto tries_in = [](int steps) {
    SimulationState state;
    return tries(steps, false, state);
  };
  for (int steps = 64; steps <= 1024; steps *= 2) {
    EXPECT_EQ(tries_in(2 * steps), tries_in(steps) + 1) << "each pause is as long as all previous steps, " << steps;
  }
}

TEST(StepRetry, DoesNotBecomeRarerWhileItHelps) {
  SimulationState state;
  EXPECT_EQ(tries(100, true, state), 100);
}

TEST(StepRetry, AllowsStepsWithMoreInfeasibleParticlesThanBefore) {
  SimulationState state;
  tries(100, false, state);
  EXPECT_FALSE(may_retry(2, state));
  EXPECT_TRUE(may_retry(3, state));
}

TEST(StepRetry, ForgetsFormerFailures) {
  SimulationState state;
  tries(5000, false, state);
  EXPECT_FALSE(may_retry(2, state));
  int feasible = 0;
  for (; !may_retry(2, state); ++feasible) {
    ++state.step;
    note_step(0, state);
  }
  EXPECT_LT(feasible, 5000) << "fewer feasible steps than failures";
  SimulationState fresh;
  EXPECT_EQ(tries(2048, false, state), tries(2048, false, fresh)) << "as with a fresh state";
}

TEST(StepRetry, StaysRareIfEveryOtherStepIsInfeasible) {
  SimulationState state;
  int tried = 0;
  for (int pair = 0; pair < 1000; ++pair) {
    tried += tries(1, false, state);
    ++state.step;
    note_step(0, state);
  }
  EXPECT_LT(tried, 20);
}

}  // namespace
}  // namespace sprung
