// When steps that squeeze particles are made again.
#include "simulation/step/step_retry.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// Of so many steps that squeeze two particles, how many are made again; `helps`: then they squeeze one.
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

TEST(StepRetry, IsNotForStepsThatSqueezeNothing) { EXPECT_FALSE(may_retry(0, {})); }

TEST(StepRetry, IsEverRarerWhileItDoesNotHelp) {
  const auto tries_in = [](int steps) {
    SimulationState state;
    return tries(steps, false, state);
  };
  for (int steps = 64; steps <= 1024; steps *= 2) {
    EXPECT_EQ(tries_in(2 * steps), tries_in(steps) + 1) << "each pause is as long as all before, in " << steps << " steps";
  }
}

TEST(StepRetry, IsNotRarerWhileItHelps) {
  SimulationState state;
  EXPECT_EQ(tries(100, true, state), 100);
}

TEST(StepRetry, IsForStepsThatSqueezeMoreThanWasLeft) {
  SimulationState state;
  tries(100, false, state);
  EXPECT_FALSE(may_retry(2, state));
  EXPECT_TRUE(may_retry(3, state));
}

TEST(StepRetry, ForgetsWhatIsOver) {
  SimulationState state;
  tries(5000, false, state);
  EXPECT_FALSE(may_retry(2, state));
  int free = 0;
  for (; !may_retry(2, state); ++free) {
    ++state.step;
    note_step(0, state);
  }
  EXPECT_LT(free, 5000) << "it does not take as long as what is over did";
  SimulationState fresh;
  EXPECT_EQ(tries(2048, false, state), tries(2048, false, fresh)) << "as from the start";
}

TEST(StepRetry, StaysRareWhereEveryOtherStepSqueezes) {
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
