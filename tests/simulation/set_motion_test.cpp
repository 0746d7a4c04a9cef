// Laws of positions and velocities that a program writes between two steps.
#include "simulation/model.h"
#include "simulation/steered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace sprung {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

Points shifted_all(const Points& positions, const Vector3& by) { return positions.colwise() + by; }

TEST(SetMotion, OfTheSameNumbersChangesNothing) {
  Simulator simulator(rope({hand({0})}), settings_of());
  run(simulator, 20 * kStep);
  const SimulationState before = simulator.state();
  simulator.set_motion(simulator.positions(), simulator.state().v);
  EXPECT_EQ(simulator.state(), before);
}

// No force depends on the place, so a rope that was moved falls as its twin; coordinates round differently.
TEST(SetMotion, AMovedRopeFallsAsItsTwinDoes) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    SimulatorSettings settings = settings_of();
    settings.integrator = integrator;
    Simulator twin(rope({}), settings);
    Simulator moved(rope({}), settings);
    const Vector3 by(2.0, -1.0, 0.5);
    for (Simulator* simulator : {&twin, &moved}) run(*simulator, 20 * kStep);
    moved.set_motion(shifted_all(moved.positions(), by), moved.state().v);
    for (Simulator* simulator : {&twin, &moved}) run(*simulator, 20 * kStep);
    EXPECT_LT((moved.positions() - shifted_all(twin.positions(), by)).cwiseAbs().maxCoeff(), 1.0e-12);
  }
}

TEST(SetMotion, AParticleFliesWithTheVelocityThatItGot) {
  for (const IntegratorSettings& integrator : all_integrators()) {
    for (const int steps_before : {0, 5}) {
      SimulatorSettings settings = settings_of(Vector3::Zero());
      settings.integrator = integrator;
      Simulator simulator(one_particle({0.0, 0.0, 0.0}), settings);
      run(simulator, steps_before * kStep);
      simulator.set_motion(simulator.positions(), Points(Vector3(1.0, 2.0, 3.0)));
      run(simulator, 10 * kStep);
      EXPECT_LT((simulator.positions().col(0) - 10 * kStep * Vector3(1.0, 2.0, 3.0)).norm(), 1.0e-14);
    }
  }
}

TEST(SetMotion, OfAPinnedParticleKeepsTheVelocityOfThePin) {
  Simulator simulator(rope({hand({0}, keyframes())}), settings_of());
  run(simulator, 100 * kStep);
  const Vector3 velocity = simulator.state().v.col(0);
  ASSERT_GT(velocity.norm(), 0.1);
  simulator.set_motion(simulator.positions(), Points(Points::Zero(3, 11)));
  EXPECT_EQ(simulator.state().v.col(0), velocity);
  EXPECT_EQ(simulator.state().v.col(5), Vector3::Zero());
}

TEST(SetMotion, WakesWhatSleeps) {
  Simulator simulator(cloth(6, 0.0001, kRough), settings_of(), {ground(kRough)});
  for (int k = 0; k < 4000 && !sleeps(simulator); ++k) simulator.step();
  ASSERT_TRUE(sleeps(simulator));
  Points velocities = simulator.state().v;
  velocities.row(1).setConstant(1.0);
  const double height = simulator.positions().row(1).mean();
  simulator.set_motion(simulator.positions(), velocities);
  EXPECT_FALSE(sleeps(simulator));
  run(simulator, 40 * kStep);
  EXPECT_GT(simulator.positions().row(1).mean(), height + 0.02);
}

TEST(SetMotion, OfAnExternalCauseIsNoExplosion) {
  Simulator simulator(rope({}), settings_of());
  run(simulator, 10 * kStep);
  simulator.set_motion(shifted_all(simulator.positions(), {0.0, 500.0, 0.0}), simulator.state().v.array() + 50.0);
  EXPECT_NO_THROW(run(simulator, 500 * kStep));
}

struct Refusal {
  std::string name;
  std::function<void(Points& positions, Points& velocities)> write;
  std::string key;
  std::string rule;
};

class SetMotionRefusal : public ::testing::TestWithParam<Refusal> {};

/// A rope beside a ball and a sheet, of which a pin holds the first particle.
Simulator beside_obstacles() {
  Obstacle thin = sheet(2.0);
  thin.rest_pose.translation() = Vector3(0.0, -0.5, 0.0);
  return Simulator(rope({hand({0})}), settings_of(), {ball({1.5, 0.0, 0.0}), thin});
}

TEST_P(SetMotionRefusal, NamesTheBodyAndChangesNothing) {
  Simulator simulator = beside_obstacles();
  Simulator twin = beside_obstacles();
  for (Simulator* each : {&simulator, &twin}) run(*each, 30 * kStep);
  Points positions = simulator.positions();
  Points velocities = simulator.state().v;
  GetParam().write(positions, velocities);
  EXPECT_THAT(refusal([&] { simulator.set_motion(positions, velocities); }),
              AllOf(HasSubstr(GetParam().key), HasSubstr(GetParam().rule)));
  for (Simulator* each : {&simulator, &twin}) run(*each, 100 * kStep);
  EXPECT_EQ(simulator.state(), twin.state());
}

INSTANTIATE_TEST_SUITE_P(
    All, SetMotionRefusal,
    ::testing::Values(
        Refusal{"Columns", [](Points& x, Points&) { x.conservativeResize(3, 4); }, "positions", "one for each particle"},
        Refusal{"NaN", [](Points& x, Points&) { x(1, 3) = kNotANumber; }, "bodies.rope.particles[3]", "must be finite"},
        Refusal{"NaNVelocity", [](Points&, Points& v) { v(1, 3) = kNotANumber; }, "bodies.rope.velocities[3]", "must be finite"},
        Refusal{"Pinned", [](Points& x, Points&) { x(0, 0) += 0.1; }, "bodies.rope.particles[0]", "is pinned"},
        Refusal{"Inside", [](Points& x, Points&) { x.col(10) = Vector3(1.45, 0.0, 0.0); }, "bodies.rope.particles", "\"ball\""},
        Refusal{"Across", [](Points& x, Points&) { x.col(10) = Vector3(1.7, 0.0, 0.0); }, "bodies.rope.particles", "\"ball\""},
        Refusal{"ThroughASheet", [](Points& x, Points&) { x.rightCols(10).row(1).array() -= 1.0; }, "bodies.rope.particles",
                "\"sheet\""}),
    [](const auto& entry) { return entry.param.name; });

// The end is free, but the way there is not.
TEST(SetMotion, MayNotCarryAWholeBodyThroughASheet) {
  Obstacle thin = sheet(2.0);
  thin.rest_pose.translation() = Vector3(0.0, -0.5, 0.0);
  Simulator simulator(rope({}), settings_of(), {thin});
  run(simulator, 10 * kStep);
  EXPECT_THAT(refusal([&] {
                simulator.set_motion(shifted_all(simulator.positions(), {0, -1.0, 0}), simulator.state().v);
              }),
              AllOf(HasSubstr("11 particles through it"), HasSubstr("\"sheet\"")));
  EXPECT_NO_THROW(simulator.set_motion(shifted_all(simulator.positions(), {0, 1.0, 0}), simulator.state().v));
}

TEST(SetMotion, MayNotCrossAnotherBody) {
  NetworkBuilder builder;
  for (const double height : {0.0, 1.0}) {
    BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {4, 4}}, {.structural = SpringMaterial{.value = 100.0}});
    set_total_mass(shape, 0.1);
    RigidTransform pose = pose_at({0.0, height, 0.0}, {-90.0, 0.0, 0.0});
    place(shape, pose);
    builder.add_body(height > 0.0 ? "upper" : "lower", shape, kRough);
  }
  Simulator simulator(builder.build(), settings_of(Vector3::Zero()));
  Points positions = simulator.positions();
  positions(1, 5) = 1.5;
  EXPECT_THAT(refusal([&] { simulator.set_motion(positions, simulator.state().v); }), HasSubstr("body \"upper\""));
}

}  // namespace
}  // namespace sprung
