// What the texts of examples/lessons claim.
#include "example_run.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sprung {
namespace {

using testing::ExampleRun;
using ::testing::HasSubstr;

constexpr double kGravity = 9.81;

double energy(const ExampleRun& run, std::size_t frame) {
  return run.column("kinetic_energy")[frame] + run.column("elastic_energy")[frame];
}

TEST(Lessons, AMassOnASpringRestsWhereItsWeightStretchesTheSpring) {
  const ExampleRun run("lessons/1_mass_on_a_spring");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  // The swing has lost e^(-c t / 2 m) = e^-20 of its amplitude.
  EXPECT_NEAR(-run.positions("masses", run.frames())(1, 1), 1.0 + kGravity / 40.0, 1.0e-6);
  EXPECT_NEAR(run.column("max_stretch").back(), 0.245, 5.0e-4);
}

TEST(Lessons, EachSpringOfARopeCarriesTheMassesBelow) {
  const ExampleRun run("lessons/2_rope_of_masses");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  const Points x = run.positions("masses", run.frames());
  const double stretch = 0.2 * kGravity / 100.0;
  for (Index spring = 0; spring < 5; ++spring) {
    // What is left of the slowest swing, of 2.3 rad/s and damped by 0.05 1/s, after 20 s.
    EXPECT_NEAR((x.col(spring) - x.col(spring + 1)).norm() - 0.2, static_cast<double>(5 - spring) * stretch, 2.0e-3) << spring;
  }
  EXPECT_NEAR(-x(1, 5), 1.0 + 0.294, 5.0e-3);
}

TEST(Lessons, DampingTakesHalfOfASwingInTheTimeOfTheText) {
  const ExampleRun run("lessons/3_damping");
  ASSERT_EQ(run.exit_code(), 0) << run.messages();
  // The energy falls by e^(-c t / m) over whole swings of 0.99 s; within one it falls in two waves, of c / (2 omega m) = 8 %.
  EXPECT_NEAR(energy(run, 90) / energy(run, 0), std::exp(-3.0), 0.1 * std::exp(-3.0));
  const ExampleRun critical("lessons/3_damping", {"--set", "bodies.masses.springs.structural.damping=12.65"});
  ASSERT_EQ(critical.exit_code(), 0) << critical.messages();
  for (int frame = 1; frame <= critical.frames(); ++frame) EXPECT_LE(critical.positions("masses", frame)(1, 1), -1.0 + 1.0e-6);
}

TEST(Lessons, ExplicitEulerDoublesTheEnergyAndTheOthersKeepIt) {
  const ExampleRun growing("lessons/4_three_integrators");
  ASSERT_EQ(growing.exit_code(), 0) << growing.messages();
  EXPECT_NEAR(energy(growing, 78) / energy(growing, 0), 2.0, 0.05);  // after 2.6 s
  const ExampleRun half("lessons/4_three_integrators", {"--set", "step=0.0033333333333"});
  EXPECT_NEAR(std::log(energy(half, 300) / 0.5), std::log(energy(growing, 300) / 0.5) / 2.0, 0.03);
  for (const std::string type : {"symplectic_euler", "verlet"}) {
    const ExampleRun run("lessons/4_three_integrators", {"--set", "integrator.type=" + type});
    ASSERT_EQ(run.exit_code(), 0) << run.messages();
    // It sways by about omega dt / 2 = 2 %.
    for (std::size_t frame = 0; frame < run.column("frame").size(); ++frame) EXPECT_NEAR(energy(run, frame), 0.5, 0.025) << type;
  }
}

TEST(Lessons, AStepBeyondTheLimitDivergesAndOneBelowDoesNot) {
  const ExampleRun run("lessons/5_a_step_that_is_too_large");
  EXPECT_NE(run.exit_code(), 0);
  EXPECT_THAT(run.messages(), HasSubstr("diverged"));
  const ExampleRun softer("lessons/5_a_step_that_is_too_large", {"--set", "bodies.masses.springs.structural.stiffness=3000"});
  EXPECT_EQ(softer.exit_code(), 0) << softer.messages();
}

TEST(Lessons, AStretchLimitHoldsWhereSoftSpringsDoNotAndStiffOnesAreRefused) {
  const ExampleRun limited("lessons/6_limit_or_stiff_springs");
  ASSERT_EQ(limited.exit_code(), 0) << limited.messages();
  EXPECT_LE(*std::ranges::max_element(limited.column("max_stretch")), 0.05 + 0.001);
  const ExampleRun soft("lessons/6_limit_or_stiff_springs", {"--set", "stretch_limit=null"});
  ASSERT_EQ(soft.exit_code(), 0) << soft.messages();
  EXPECT_GT(*std::ranges::max_element(soft.column("max_stretch")), 0.2);
  const ExampleRun stiff("lessons/6_limit_or_stiff_springs", {"--set", "bodies.cloth.springs.structural.stiffness=4000"});
  EXPECT_THAT(stiff.messages(), HasSubstr("beyond the largest stable step"));
}

}  // namespace
}  // namespace sprung
