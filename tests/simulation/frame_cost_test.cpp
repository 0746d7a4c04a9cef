// Laws of the cost of a frame. A clock that the test advances stands for the time.
#include "simulation/frame_cost.h"
#include "network/network_builder.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::cloth;
using testing::ground;
using testing::one_particle;

/// Each look at the clock takes `tick` [s].
struct Ticking {
  double tick = 0.0;
  int looks = 0;
  double operator()() { return ++looks * tick; }
};

/// One fixed particle, and one that would fall.
NetworkBuilder pendulum() {
  NetworkBuilder builder;
  builder.begin_body("pendulum");
  const Index hook = builder.add_particle({0.0, 2.0, 0.0}, 1.0);
  const Index bob = builder.add_particle({0.0, 1.0, 0.0}, 1.0);
  builder.add_spring(hook, bob, 100.0, 1.0, 0.5);
  return builder;
}

SpringNetwork self_colliding_cloth(double thickness) {
  SpringNetwork network = cloth(5, 2.0, {.thickness = thickness});
  network.bodies.front().contact.self = true;
  return network;
}

// A step looks at the clock before its only substep and at its end, so it takes two ticks.
TEST(FrameCost, OfAShortStepIsMeasuredOnTen) {
  Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = 1e-2});
  Ticking clock{.tick = 1.0 / 1024.0};
  const FrameCost cost = measure_frame_cost(simulator, 3, 1, std::ref(clock));
  EXPECT_EQ(cost.steps, 10);
  EXPECT_EQ(simulator.state().step, 10);
  EXPECT_EQ(cost.free, 3 * 2.0 * clock.tick);
  EXPECT_FALSE(cost.failure);
}

// A step and the loop around it look at the clock four times, so that the fourth step ends after a second.
TEST(FrameCost, MeasurementEndsAfterASecond) {
  Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = 1e-2});
  Ticking clock{.tick = 1.0 / 16.0};
  const FrameCost cost = measure_frame_cost(simulator, 3, 1, std::ref(clock));
  EXPECT_EQ(cost.steps, 4);
  EXPECT_EQ(simulator.state().step, cost.steps);
  EXPECT_LE(clock.looks * clock.tick, kLongestMeasurement + 4 * clock.tick);
}

// A look at the clock takes 0.2 s. The first step begins after two looks and takes two, so that a second one would end after 1.2 s.
TEST(FrameCost, MeasurementBeginsNoStepThatWouldEndAfterASecond) {
  Simulator simulator(one_particle({0.0, 1.0, 0.0}), {.step = 1e-2});
  Ticking clock{.tick = 0.2};
  EXPECT_EQ(measure_frame_cost(simulator, 3, 1, std::ref(clock)).steps, 1);
}

// A pin that turns by ten right angles a step needs 20 substeps, each of which would take a quarter of a second.
TEST(FrameCost, OfAStepThatTakesLongerThanTheMeasurementIsALowerBound) {
  NetworkBuilder builder = pendulum();
  builder.pin(0, {.spin = {0.0, 900.0e3, 0.0}});
  Simulator simulator(builder.build(), {.step = 1e-3});
  Ticking clock{.tick = 0.25};
  const FrameCost cost = measure_frame_cost(simulator, 3, 1, std::ref(clock));
  EXPECT_EQ(cost.steps, 0);
  EXPECT_GE(cost.free, 3 * kLongestMeasurement);
  EXPECT_LT(clock.looks, 10);
}

TEST(FrameCost, TellsWhyTheFirstStepsDiverge) {
  NetworkBuilder builder = pendulum();
  builder.pin(0);
  Simulator simulator(builder.build(), {.step = 1.0, .stability = StabilityCheck::warn});
  Ticking clock{.tick = 1e-6};
  const FrameCost cost = measure_frame_cost(simulator, 1, 1, std::ref(clock));
  ASSERT_TRUE(cost.failure);
  EXPECT_THAT(*cost.failure, ::testing::HasSubstr("diverged"));
  EXPECT_LT(cost.steps, 10);
}

TEST(FrameCost, InFullContactIsThatOfAFreeFrameIfNothingCanTouch) {
  Simulator simulator(cloth(5, 2.0), {.step = 1e-4});
  const FrameCost cost = measure_frame_cost(simulator, 3, 1, Ticking{.tick = 1e-6});
  EXPECT_EQ(cost.full, cost.free);
  EXPECT_FALSE(cost.can_touch);
}

// The first steps may not need the passes.
TEST(FrameCost, GrowsWithThePassesThatAStretchLimitMayMake) {
  const auto full = [](int iterations) {
    Simulator simulator(cloth(5, 2.0), {.step = 1e-4, .stretch_limit = StretchLimitSettings{.iterations = iterations}});
    return measure_frame_cost(simulator, 3, 1, Ticking{.tick = 1e-9}).full;
  };
  EXPECT_GT(full(64), full(8));
}

TEST(FrameCost, InFullContactIsLargerForEachIntegrator) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    Simulator simulator(cloth(5, 2.0), {.step = 1e-4, .integrator = integrator, .stability = StabilityCheck::warn}, {ground()});
    const FrameCost cost = measure_frame_cost(simulator, 3, 1, Ticking{.tick = 1e-6});
    EXPECT_GT(cost.full, cost.free);
  }
}

// More elements lie within a larger thickness: the edges are 0.25 m long.
TEST(FrameCost, OfSelfContactGrowsWithTheThicknessAndShrinksWithTheThreads) {
  const auto in_contact = [](double thickness, int threads) {
    Simulator simulator(self_colliding_cloth(thickness), {.step = 1e-4});
    return measure_frame_cost(simulator, 3, threads, Ticking{.tick = 1e-9}).full;
  };
  EXPECT_GT(in_contact(0.5, 1), 1.1 * in_contact(0.01, 1));
  EXPECT_LT(in_contact(0.01, 2), in_contact(0.01, 1));
}

TEST(FrameCost, OfPinnedAndOfSleepingBodiesIsMeasured) {
  NetworkBuilder builder = pendulum();
  builder.pin({0, 1});
  Simulator pinned(builder.build(), {.step = 1e-2});
  EXPECT_EQ(measure_frame_cost(pinned, 3, 1, Ticking{.tick = 1e-6}).steps, 10);

  const ContactMaterial rough{.thickness = 0.005, .friction = 0.4, .static_friction = 0.4};
  Simulator sleeping(cloth(4, 0.01, rough), {.step = 5e-4}, {ground(rough)});
  testing::run(sleeping, 0.6);
  ASSERT_TRUE(testing::sleeps(sleeping));
  const FrameCost cost = measure_frame_cost(sleeping, 3, 1, Ticking{.tick = 1e-6});
  EXPECT_EQ(cost.steps, 10);
  EXPECT_GE(cost.full, cost.free);
}

}  // namespace
}  // namespace sprung
