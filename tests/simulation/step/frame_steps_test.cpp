#include "simulation/step/frame_steps.h"

#include "base/format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace sprung {
namespace {

TEST(FrameSteps, FirstFrameIsTimeZero) {
  EXPECT_EQ(frame_count(0.0, 30.0), 1);
  EXPECT_EQ(frame_count(1.0, 30.0), 31);
  EXPECT_EQ(frame_count(0.99, 30.0), 30);  // 29.7 frames: the last one reached is frame 30, at 29 / 30 s
  EXPECT_EQ(frame_count(600.0, 1.0), 601);
}

TEST(FrameSteps, RoundingOfTheDurationLosesNoFrame) {
  for (int frames = 1; frames < 1000; ++frames) {
    EXPECT_EQ(frame_count(frames / 29.97, 29.97), frames + 1);
    EXPECT_EQ(frame_count(frames * 0.1, 10.0), frames + 1);
  }
}

TEST(FrameSteps, AStepToTypeHasThreeDigitsIsAcceptedAndMeansNoMoreThanTheBound) {
  for (const double frame_rate : {1.0, 24.0, 25.0, 29.97, 30.0, 60.0, 99.9, 1000.0}) {
    for (double largest = 2.0; largest > 1e-6; largest *= 0.731) {
      const double step = step_to_type(frame_rate, largest).value();
      EXPECT_EQ(std::stod(format_number(step, 3)), step);
      const int steps = steps_per_frame(frame_rate, step).value();
      EXPECT_LE(step_meant(frame_rate, step, steps), largest);
      // Three digits lose 1 % at most, and as much again where the last one is 0, which is refused.
      EXPECT_LE(steps, 1.02 * fewest_steps_per_frame(frame_rate, largest).value() + 2) << frame_rate << " " << largest;
    }
  }
  EXPECT_EQ(step_to_type(50.0, 0.0063), 0.005);
  EXPECT_EQ(step_to_type(30.0, 0.02), 0.0166);
  EXPECT_EQ(step_to_type(50.0, std::numeric_limits<double>::infinity()), 0.02);
  EXPECT_EQ(step_to_type(50.0, 1e-12), std::nullopt) << "too many steps";
}

TEST(FrameSteps, AStepRoundedDownToThreeDigitsIsTheExactOne) {
  EXPECT_EQ(steps_per_frame(30.0, 0.0333), 1);
  EXPECT_EQ(step_meant(30.0, 0.0333, 1), 1.0 / 30.0);
  EXPECT_EQ(steps_per_frame(24.0, 0.00833), 5);
  EXPECT_EQ(step_meant(25.0, 0.001, 40), 0.001);
  for (const double other : {0.033, 0.03333, 0.0334, 0.0332, 0.0167})
    EXPECT_EQ(steps_per_frame(30.0, other), std::nullopt) << other;
}

TEST(FrameSteps, StepsThatDivideAFrameAreWhole) {
  EXPECT_EQ(steps_per_frame(30.0, 1.0 / 30.0), 1);
  EXPECT_EQ(steps_per_frame(25.0, 0.001), 40);
  EXPECT_EQ(steps_per_frame(1.0, 1.0), 1);
  for (const int steps : {1, 3, 7, 1000, 99'999, 1'234'567, 99'999'999}) {
    EXPECT_EQ(steps_per_frame(29.97, step_of(29.97, steps)), steps);
  }
}

TEST(FrameSteps, TheTextOfAStepIsTheShortestThatIsAccepted) {
  EXPECT_EQ(step_text(25.0, 400), "0.0001");
  EXPECT_EQ(step_text(30.0, 333), "0.0001001001001");  // without the last three digits: 333.0000003 steps
  for (const double frame_rate : {24.0, 29.97, 30.0, 60.0}) {
    for (const int steps : {1, 3, 7, 333, 99'999, 99'999'999}) {
      EXPECT_EQ(steps_per_frame(frame_rate, std::stod(step_text(frame_rate, steps))), steps) << frame_rate;
    }
  }
}

TEST(FrameSteps, OtherStepsAreRefused) {
  EXPECT_EQ(steps_per_frame(25.0, 0.003), std::nullopt);
  EXPECT_EQ(steps_per_frame(25.0, 0.08), std::nullopt);  // half a step per frame
  EXPECT_EQ(steps_per_frame(25.0, 0.04 * (1.0 + 1e-8)), std::nullopt);
  EXPECT_EQ(steps_per_frame(25.0, 0.04 * (1.0 + 1e-10)), 1);
  EXPECT_EQ(steps_per_frame(25.0, 1e-30), std::nullopt);
}

TEST(FrameSteps, FewestStepsAreJustEnough) {
  for (const double frame_rate : {1.0, 24.0, 29.97, 60.0}) {
    for (double largest = 2.0; largest > 1e-5; largest *= 0.731) {
      const int steps = fewest_steps_per_frame(frame_rate, largest).value();
      EXPECT_LE(step_of(frame_rate, steps), largest);
      if (steps > 1) {
        EXPECT_GT(step_of(frame_rate, steps - 1), largest);
      }
    }
  }
}

TEST(FrameSteps, LargestStepThatDividesAFrameIsKept) {
  for (const int steps : {1, 3, 7, 49, 1000, 99'999}) EXPECT_EQ(fewest_steps_per_frame(29.97, step_of(29.97, steps)), steps);
  EXPECT_EQ(fewest_steps_per_frame(30.0, std::numeric_limits<double>::infinity()), 1);
}

TEST(FrameSteps, RefusesTooManyStepsPerFrame) { EXPECT_EQ(fewest_steps_per_frame(30.0, 1e-12), std::nullopt); }

}  // namespace
}  // namespace sprung
