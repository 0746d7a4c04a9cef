// Laws of pins that follow obstacles, begin during a run, and end.
#include "base/error.h"
#include "dynamics/integrators/stable_step.h"
#include "dynamics/network_bounds.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sprung {
namespace {

using testing::deforming_sheet;
using testing::ground;
using ::testing::HasSubstr;
using testing::kGravity;
using testing::one_particle;
using testing::run;

constexpr double kStep = 1.0e-3;  // [s]
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// From 0 to 1 m along x in one second, and on.
const Motion kOneMetrePerSecond{.keyframes = {{.time = 0.0}, {.time = 10.0, .position = {10.0, 0.0, 0.0}}}};

SpringNetwork pinned_particles(const std::vector<Vector3>& positions, const std::vector<Pin>& pins) {
  NetworkBuilder builder;
  for (const Vector3& position : positions) builder.add_particle(position, 0.1);
  for (const Pin& pin : pins) builder.add_pin(pin);
  return builder.build();
}

SpringNetwork pinned_particle(const std::vector<Pin>& pins) { return pinned_particles({Vector3(0.0, 1.0, 0.0)}, pins); }

Pin pin_of(std::vector<Index> particles, double from, double until = std::numeric_limits<double>::infinity(),
           const Motion& motion = {}) {
  return {.particles = std::move(particles), .motion = motion, .from = from, .until = until};
}

class Pins : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] SimulatorSettings settings(double gravity = kGravity) const {
    return {.step = kStep, .gravity = {0.0, -gravity, 0.0}, .integrator = all_integrators()[GetParam()]};
  }
};

INSTANTIATE_TEST_SUITE_P(Integrators, Pins, ::testing::Range(std::size_t{0}, all_integrators().size()));

TEST_P(Pins, APinThatBeginsDuringTheRunHoldsItsParticleWhereItIsThen) {
  Simulator free(pinned_particle({}), settings());
  Simulator held(pinned_particle({pin_of({0}, 0.2004, 0.4996)}), settings());  // rounded to 0.2 and 0.5
  run(free, 0.2);
  run(held, 0.2);
  EXPECT_EQ(held.positions(), free.positions());
  const Points where = held.positions();
  EXPECT_LT(where(1, 0), 0.9);
  while (held.state().step < 500) {
    held.step();
    EXPECT_EQ(held.positions(), where);
    EXPECT_EQ(held.state().v, Points::Zero(3, 1));
  }
  run(held, 0.2);
  // A fall of n steps from rest: n^2 / 2 up to n steps of half a step's gravity.
  EXPECT_NEAR(held.positions()(1, 0), where(1, 0) - 0.5 * kGravity * 0.04, kGravity * 0.2 * kStep);
  EXPECT_NEAR(held.state().v(1, 0), -kGravity * 0.2, kGravity * kStep);
}

// Both the pin and the free particle move by whole steps; the rounding of n sums of x is n epsilon |x|, and a velocity is a
// difference of positions divided by the step.
TEST_P(Pins, AParticleGoesOnWithTheVelocityOfItsPin) {
  const Motion stops_there{.keyframes = {{.time = 0.0}, {.time = 0.6, .position = {0.6, 0.0, 0.0}}}};
  for (const Motion& motion : {kOneMetrePerSecond, stops_there}) {
    for (const double from : {0.0, 0.3}) {
      Simulator simulator(pinned_particle({pin_of({0}, from, 0.6, motion)}), settings(0.0));
      run(simulator, 0.6);
      const Vector3 at_end = simulator.positions();
      EXPECT_NEAR(at_end.x(), 0.6 - from, 8.0 * kEpsilon);
      const double rounding = 8.0 * kEpsilon / kStep;
      for (int step = 1; step <= 200; ++step) {
        simulator.step();
        EXPECT_LE((simulator.state().v.col(0) - Vector3::UnitX()).norm(), rounding);
        EXPECT_LE((simulator.positions().col(0) - at_end - step * kStep * Vector3::UnitX()).norm(), step * kStep * rounding);
      }
    }
  }
}

TEST_P(Pins, APinBeginsWhereAnotherEnds) {
  Simulator simulator(pinned_particle({pin_of({0}, 0.4, 0.7), pin_of({0}, 0.1, 0.4, kOneMetrePerSecond)}), settings());
  run(simulator, 0.4);
  const Points where = simulator.positions();
  EXPECT_NEAR(where(0, 0), 0.3, 8.0 * kEpsilon);
  run(simulator, 0.3);
  EXPECT_EQ(simulator.positions(), where);
  EXPECT_EQ(simulator.state().v, Points::Zero(3, 1));
  simulator.step();
  EXPECT_FALSE(simulator.network().is_fixed(0));
}

Obstacle turning_ball() {
  RigidTransform placed = RigidTransform::Identity();
  placed.linear() = rotation_from_degrees({10.0, 20.0, 30.0});
  placed.translation() = Vector3(0.5, -2.0, 0.25);
  return {.name = "ball",
          .geometry = SphereGeometry{0.1},
          .rest_pose = placed,
          .motion = {.keyframes = {{.time = 0.0, .position = {0.0, 0.5, 0.0}},
                                   {.time = 1.0, .position = {1.0, 0.0, 2.0}, .rotation = {40.0, 50.0, 60.0}}},
                     .interpolation = Interpolation::smooth,
                     .spin = {30.0, -300.0, 70.0}}};
}

TEST_P(Pins, ParticlesKeepTheirPlaceOnARigidObstacleThatTheyFollow) {
  const std::vector<Vector3> positions{{0.0, 1.0, 0.0}, {1.0, 1.0, 2.0}, {-1.0, 0.5, 0.5}};
  for (const double from : {0.0, 0.25}) {
    Pin pin = pin_of({0, 1, 2}, from);
    pin.obstacle = 1;
    Simulator simulator(pinned_particles(positions, {pin}), settings(), {ground({}, 0.0), turning_ball()});
    const Obstacle& ball = simulator.obstacles()[1];
    const auto on_ball = [&] {
      return Points(ball.motion.pose(ball.rest_pose, simulator.time()).inverse() * simulator.positions());
    };
    run(simulator, from);
    const Points place = on_ball();
    while (simulator.time() < from + 0.5) {
      simulator.step();
      EXPECT_LE((on_ball() - place).colwise().norm().maxCoeff(), 1e-12) << simulator.time();
    }
    EXPECT_GT((simulator.positions().col(0) - positions[0]).norm(), 0.5);
  }
}

// Vertices move on straight lines, so at time t the sheet is that of the map (1 - t) I + t M.
TEST_P(Pins, ParticlesKeepTheirPlaceOverADeformingObstacleThatTheyFollow) {
  const Matrix3 map = (Matrix3() << 1.5, 0.0, 0.2, 0.7, 1.0, -0.3, 0.1, 0.0, 0.8).finished();
  for (const double from : {0.0, 0.25}) {
    Pin pin = pin_of({0, 1}, from);
    pin.obstacle = 0;
    const SpringNetwork network = pinned_particles({{0.3, 1.5, 0.6}, {-0.2, 1.2, -0.7}}, {pin});
    Simulator simulator(network, settings(), {deforming_sheet(map)});
    const auto map_now = [&] {
      const double t = simulator.time();
      return Matrix3((1.0 - t) * Matrix3::Identity() + t * map);
    };
    const auto normal_now = [&] { return Vector3(map_now().col(2).cross(map_now().col(0)).normalized()); };
    run(simulator, from);
    const Vector3 normal = normal_now();
    const Scalars heights = simulator.positions().transpose() * normal;
    const Points feet = map_now().inverse() * (simulator.positions() - normal * heights.transpose());
    while (simulator.time() < from + 0.5) {
      simulator.step();
      const Points expected = map_now() * feet + normal_now() * heights.transpose();
      EXPECT_LE((simulator.positions() - expected).colwise().norm().maxCoeff(), 1e-12) << simulator.time();
    }
  }
}

// A change between steps builds the simulator anew, and the pin must not take its particle a second time.
TEST_P(Pins, AChangeOfTheSimulatorDoesNotDisturbAPinThatHolds) {
  const SpringNetwork network = pinned_particle({pin_of({0}, 0.2, 0.6, {.keyframes = {}, .spin = {10.0, 20.0, 300.0}})});
  Simulator whole(network, settings());
  Simulator changed(network, settings());
  for (int k = 0; k < 7; ++k) {
    run(whole, 0.1);
    run(changed, 0.1);
    changed.continue_with(k % 2 == 0 ? network : changed.network(), changed.settings());
    EXPECT_EQ(changed.positions(), whole.positions()) << k;
  }
}

TEST(PinTimes, ARunSleepsOnlyOnceNoPinWillBeginOrEnd) {
  const Motion up{.keyframes = {{.time = 2.0}, {.time = 2.5, .position = {0.0, 0.5, 0.0}}}};
  NetworkBuilder builder;
  builder.begin_body("ball", {.thickness = 0.01, .friction = 0.5, .static_friction = 0.5});
  builder.add_particle({0.0, 0.01, 0.0}, 0.1);
  builder.add_pin(pin_of({0}, 2.0, 3.0, up));
  Simulator simulator(builder.build(), {.step = kStep}, {ground({.friction = 0.5, .static_friction = 0.5})});
  run(simulator, 2.9);
  EXPECT_FALSE(testing::sleeps(simulator, 0));
  EXPECT_NEAR(simulator.positions()(1, 0), 0.51, 1e-6);
  run(simulator, 3.0);
  EXPECT_TRUE(testing::sleeps(simulator, 0));
  EXPECT_NEAR(simulator.positions()(1, 0), 0.01, 1e-6);
}

// Two particles of mass m on a spring: omega^2 = k / m if one is pinned, and 2 k / m if both are free.
TEST(PinTimes, TheLargestStableStepHoldsForEverySetOfPins) {
  const double stiffness = 1000.0;
  const double mass = 0.1;
  const SimulatorSettings settings{.step = 0.9 * 2.0 / std::sqrt(stiffness / mass), .integrator = SymplecticEulerSettings{}};
  const auto start = [&](double from, double until) {
    NetworkBuilder builder;
    builder.add_particle({0.0, 0.0, 0.0}, mass);
    builder.add_particle({1.0, 0.0, 0.0}, mass);
    builder.add_spring(0, 1, stiffness, 1.0);
    builder.add_pin(pin_of({0}, from, until));
    const Simulator simulator(builder.build(), settings);
  };
  EXPECT_NO_THROW(start(0.0, std::numeric_limits<double>::infinity()));
  EXPECT_THROW(start(0.0, 0.5), InputError);
  EXPECT_THROW(start(0.5, std::numeric_limits<double>::infinity()), InputError);
}

// Near the largest stable step, a bound that each set of pins had for itself could refuse the step in the middle of the run.
TEST(PinTimes, AStepThatIsAcceptedAtTheStartIsAcceptedWheneverPinsChange) {
  const Index side = 6;
  SpringNetwork network = testing::cloth(side, 1.0);
  network.pins = {pin_of({0, side - 1}, 0.05, 0.1), pin_of({0}, 0.1), pin_of({7, 8, 9}, 0.02, 0.15)};
  const double largest = largest_stable_step(SymplecticEulerSettings{}, spectral_bounds(network, 0.0));
  Simulator simulator(network, {.step = largest, .integrator = SymplecticEulerSettings{}});
  EXPECT_NO_THROW(run(simulator, 0.3));
  EXPECT_EQ(simulator.state().activity.phases, (std::vector<PinPhase>{PinPhase::over, PinPhase::holding, PinPhase::over}));
}

TEST(PinTimes, APinOfAMissingObstacleIsAProblem) {
  Pin pin = pin_of({0}, 1.0);
  pin.obstacle = 1;
  try {
    const Simulator simulator(pinned_particle({pin}), {}, {ground()});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].key, "pins[0].obstacle");
    EXPECT_THAT(error.problems()[0].rule, HasSubstr("there are 1"));
  }
}

}  // namespace
}  // namespace sprung
