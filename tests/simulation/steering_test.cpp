// Laws of pins and obstacles that a program moves, and of gravity that it sets.
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/constraints/constraint.h"
#include "simulation/model.h"
#include "simulation/steered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

namespace sprung {
namespace {

using namespace testing;
using ::testing::HasSubstr;

// Obstacles.

TEST(MoveObstacle, IsExactlyAtItsPoseAtTheEndOfTheStepAndStaysThere) {
  Simulator simulator(cloth(6, 1.0), settings_of(), {ball({0.0, 0.0, 0.0})});
  RigidTransform pose = RigidTransform::Identity();
  for (int k = 0; k < 20; ++k) {
    const RigidTransform before = pose;
    pose = pose_at({0.01 * k, -0.02 * k, 0.003}, {3.0 * k, 5.0, -2.0 * k});
    simulator.move_obstacle(0, pose);
    EXPECT_EQ(simulator.obstacle_pose(0).matrix(), before.matrix()) << "not before the step";
    simulator.step();
    EXPECT_EQ(simulator.obstacle_pose(0).matrix(), pose.matrix());
  }
  run(simulator, 8 * kStep);
  EXPECT_EQ(simulator.obstacle_pose(0).matrix(), pose.matrix());
  const Vector3 velocity = simulator.obstacle_frame().surface_velocity(0, Vector3::Zero(), simulator.time(), kStep);
  EXPECT_LT(velocity.norm(), 8.0 * kEpsilon / kStep) << "it stands, but for the rounding of two poses";
}

TEST(MoveObstacle, OfTwoMovesBeforeAStepTheSecondHolds) {
  Simulator simulator(cloth(6, 1.0), settings_of(), {ball({0.0, 0.0, 0.0})});
  for (int k = 0; k < 3; ++k) {
    simulator.move_obstacle(0, pose_at({-0.1, 0.0, 0.0}));
    simulator.move_obstacle(0, pose_at({0.1 * k, 0.0, 0.0}));
    simulator.step();
    EXPECT_EQ(simulator.obstacle_pose(0).translation(), Vector3(0.1 * k, 0.0, 0.0));
  }
}

// Substeps see the pose between steps: on a line, and rotated at a constant rate, as keyframes do that rotate about one axis. Slerp
// rounds otherwise than angles do; a difference of some epsilons in contact grows by the stiffness of springs.
TEST(MoveObstacle, FollowsTheKeyframesOfATwin) {
  Obstacle keyed = ball({0.45, -0.12, 0.0});
  keyed.motion = keyframes();
  Obstacle placed = keyed;
  placed.motion = {};
  Simulator twin(rope({hand({0, 10})}), settings_of(), {keyed});
  Simulator steered(rope({hand({0, 10})}), settings_of(), {placed});
  Index contacts = 0;
  while (twin.time() < 300 * kStep) {
    steered.move_obstacle(0, keyed.motion.pose(keyed.rest_pose, twin.time() + kStep));
    twin.step();
    steered.step();
    contacts += steered.contact_count();
  }
  EXPECT_GT(contacts, 100);
  EXPECT_LT(farthest(twin, steered), 1e-10);
  EXPECT_EQ(steered.obstacle_pose(0).matrix(), twin.obstacle_pose(0).matrix());
}

TEST(MoveObstacle, CarriesPinsAndAttachmentsThatFollowIt) {
  Pin follower = hand({0});
  follower.obstacle = 0;
  SpringNetwork network = rope({follower});
  network.attachments.push_back({.name = "rod", .particles = {10}, .second = ObstacleEnd{1}});
  Simulator simulator(network, settings_of(), {ball({-0.2, 0.0, 0.0}), ball({1.2, 0.0, 0.0})});
  const Vector3 on_first = simulator.obstacle_pose(0).inverse() * simulator.positions().col(0);
  simulator.step();
  for (int k = 1; k < 100; ++k) {
    simulator.move_obstacle(0, pose_at({-0.2, 0.002 * k, 0.0}, {0.0, 0.0, 0.2 * k}));
    simulator.move_obstacle(1, pose_at({1.2, 0.001 * k, 0.001 * k}));
    simulator.step();
    EXPECT_LT((simulator.obstacle_pose(0) * on_first - simulator.positions().col(0)).norm(), 16.0 * kEpsilon);
    ASSERT_EQ(simulator.state().links.size(), 1U);
    const Link& rod = simulator.state().links[0];
    const double distance = (simulator.obstacle_pose(1) * rod.anchor - simulator.positions().col(10)).norm();
    EXPECT_NEAR(distance, rod.length, 1e-3 * rod.length) << "rods keep their length to a thousandth";
  }
  EXPECT_THAT(refusal([&] { simulator.move_pin(0, RigidTransform::Identity()); }),
              HasSubstr("pins.hand.pose = [0, 0, 0]: cannot be given: the pin follows obstacles.ball; move the obstacle"));
}

// The sheet goes on to deform in its own frame, and what a pin holds on it follows both.
TEST(MoveObstacle, ADeformingOneDeformsOn) {
  const Matrix3 map = Vector3(0.8, 1.0, 1.2).asDiagonal();
  Pin follower = hand({0});
  follower.obstacle = 0;
  Simulator simulator(rope({follower}), settings_of(), {[&] {
                        Obstacle sheet = deforming_sheet(map);
                        sheet.rest_pose.translation() = Vector3(0.0, -0.2, 0.0);
                        return sheet;
                      }()});
  const Vector3 start = Vector3(0.0, 0.2, 0.0);  // on the sheet
  for (int k = 1; k <= 256; ++k) {
    simulator.move_obstacle(0, pose_at({0.0, -0.2 + 0.001 * k, 0.0}, {0.0, 0.1 * k, 0.0}));
    simulator.step();
  }
  // A quarter of a second; the middle of the sheet does not move in its frame, and the particle is above it.
  EXPECT_LT((simulator.obstacle_pose(0) * start - simulator.positions().col(0)).norm(), 64.0 * kEpsilon);
}

// Pins.

TEST(MovePin, IsExactlyAtItsPoseAndMovesItsParticlesRigidly) {
  Simulator simulator(rope({hand({0, 1})}), settings_of());
  const RigidTransform start = simulator.pin_pose(0);
  const Points held = simulator.positions().leftCols(2);
  for (int k = 0; k < 50; ++k) {
    const RigidTransform pose = pose_at({0.0, 0.002 * k, 0.001 * k}, {0.0, 0.0, 1.0 * k});
    simulator.move_pin(0, pose);
    simulator.step();
    EXPECT_EQ(simulator.pin_pose(0).matrix(), pose.matrix());
    const Points expected = pose * start.inverse() * held;
    EXPECT_LT((simulator.positions().leftCols(2) - expected).cwiseAbs().maxCoeff(), 16.0 * kEpsilon);
  }
}

// Steered, it moves its particles from where they are; with keyframes, from where the network has them. Both are the same to
// rounding, which springs of 100 N/m on 0.01 kg make no larger than the sum of that of all steps.
TEST(MovePin, FollowsTheKeyframesOfATwin) {
  Simulator twin(rope({hand({0, 10}, keyframes())}), settings_of());
  Simulator steered(rope({hand({0, 10})}), settings_of());
  while (twin.time() < 300 * kStep) {
    steered.move_pin(0, keyframes().pose(RigidTransform::Identity(), twin.time() + kStep));
    twin.step();
    steered.step();
    EXPECT_LT(farthest(twin, steered), 300 * 64.0 * kEpsilon) << "at " << twin.time() << " s";
  }
}

TEST(MovePin, WhatItReleasesGoesOnWithItsVelocity) {
  NetworkBuilder builder;
  builder.add_particle({0.0, 0.0, 0.0}, 0.1);
  builder.pin(0);
  Simulator simulator(builder.build(), settings_of(Vector3::Zero()));
  const Vector3 velocity(0.5, -1.0, 2.0);
  for (int k = 0; k < 16; ++k) {
    simulator.move_pin(0, shifted(simulator.pin_pose(0), kStep * velocity));
    simulator.step();
  }
  const Vector3 at_release = simulator.positions();
  simulator.release(0);
  run(simulator, 64 * kStep);
  // A velocity is a difference of positions of up to 0.03 m, divided by the step; it acts for 64 steps.
  EXPECT_LT((simulator.positions() - at_release - 64 * kStep * velocity).norm(), 64 * 64 * kEpsilon);
}

// The obstacle has moved before the pin begins, stands, and moves on; a second pin of it begins later.
TEST(MovePin, APinThatBeginsLateFollowsASteeredObstacle) {
  Pin first = hand({0});
  first.obstacle = 0;
  first.from = 20 * kStep;
  Pin second = first;
  second.particles = {10};
  second.name = "second";
  second.from = 35 * kStep;
  Simulator simulator(rope({first, second}), settings_of(), {ball({0.5, -0.5, 0.0})});
  std::array<Vector3, 2> on_ball{Vector3::Zero(), Vector3::Zero()};
  for (int k = 1; k <= 80; ++k) {
    if (k < 15 || k > 25) simulator.move_obstacle(0, pose_at({0.5, -0.5 + 0.001 * k, 0.0}, {0.0, 0.0, 0.3 * k}));
    simulator.step();
    const RigidTransform pose = simulator.obstacle_pose(0);
    if (k == 20) on_ball[0] = pose.inverse() * simulator.positions().col(0);
    if (k == 35) on_ball[1] = pose.inverse() * simulator.positions().col(10);
    const double off_first = (pose * on_ball[0] - simulator.positions().col(0)).norm();
    const double off_second = (pose * on_ball[1] - simulator.positions().col(10)).norm();
    EXPECT_TRUE(k <= 20 || off_first < 32.0 * kEpsilon) << "step " << k << ": " << off_first;
    EXPECT_TRUE(k <= 35 || off_second < 32.0 * kEpsilon) << "step " << k << ": " << off_second;
  }
}

TEST(MovePin, NeedsAPinThatHoldsParticlesInTheNextStep) {
  Pin later = hand({0});
  later.from = 10 * kStep;
  later.until = 20 * kStep;
  Simulator simulator(rope({later}), settings_of());
  const std::string none =
      "pins.hand.pose = [0, 0.1, 0]: cannot be given: the pin holds no particle now; move it while it holds one";
  for (int k = 0; k <= 22; ++k) {
    SCOPED_TRACE(k);
    const bool holds = k >= 10 && k <= 20;
    const std::string said = refusal([&] { simulator.move_pin(0, pose_at({0.0, 0.1, 0.0})); });
    EXPECT_THAT(said, HasSubstr(holds ? "accepted" : none));
    simulator.step();
  }
  const std::size_t added = simulator.pin({5}, "gripper");
  simulator.release(5);
  EXPECT_THAT(refusal([&] { simulator.move_pin(added, simulator.pin_pose(added)); }), HasSubstr("the pin holds no particle now"));
}

// Sleep.

class SteeredSleep : public ::testing::Test {
 protected:
  SteeredSleep() : simulator_(network(), settings_of(), {ground(kRough), ball({3.0, 0.5, 0.0})}) { run(simulator_, 0.75); }
  static SpringNetwork network() {
    NetworkBuilder builder;
    BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {4, 4}},
                                 {.structural = SpringMaterial{.value = 200.0, .damping = 0.01}, .shear = {}, .bend = {}});
    set_total_mass(shape, 0.2);
    place(shape, pose_at({0.0, 0.01, 0.0}, {-90.0, 0.0, 0.0}), Vector3::Zero());
    builder.add_body("cloth", shape, kRough);
    builder.begin_body("pearl", kRough);
    builder.pin(builder.add_particle({3.0, 1.5, 0.0}, 0.1));
    return builder.build();
  }
  Simulator simulator_;
};

TEST_F(SteeredSleep, GoesOnWhileSteeringIsFar) {
  ASSERT_TRUE(sleeps(simulator_, 0));
  const Points positions = simulator_.positions();
  for (int k = 1; k < 600; ++k) {
    simulator_.move_obstacle(1, pose_at({3.0 + 1e-4 * k, 0.5, 0.0}));
    simulator_.move_pin(0, pose_at({0.0, 1e-4 * k, 0.0}));
    simulator_.step();
    ASSERT_TRUE(sleeps(simulator_, 0)) << "step " << k;
  }
  EXPECT_EQ(simulator_.positions().leftCols(16), positions.leftCols(16));
}

TEST_F(SteeredSleep, EndsWhenAnObstacleComes) {
  ASSERT_TRUE(sleeps(simulator_, 0));
  Vector3 position(3.0, 0.5, 0.0);
  while (position.x() > 0.3) {
    position += Vector3(-0.01, -0.0014, 0.0);
    simulator_.move_obstacle(1, pose_at(position));
    simulator_.step();
    const bool comes = simulator_.obstacle_frame().min_distance(simulator_.positions(), 0.008).has_value();  // the ground does not
    EXPECT_FALSE(comes && sleeps(simulator_, 0)) << "at " << position.transpose();
  }
  EXPECT_FALSE(sleeps(simulator_, 0));
}

TEST_F(SteeredSleep, ReleaseAndPinWakeIt) {
  ASSERT_TRUE(sleeps(simulator_, 0));
  simulator_.release(5);
  EXPECT_TRUE(sleeps(simulator_, 0)) << "it was free";
  simulator_.pin({5}, "finger");
  EXPECT_FALSE(sleeps(simulator_, 0));
  simulator_.move_pin(1, shifted(simulator_.pin_pose(1), {0.0, 0.05, 0.0}));
  simulator_.step();
  EXPECT_GT(simulator_.positions()(1, 5), 0.05);
}

TEST_F(SteeredSleep, EndsWithTheFirstMoveOfTheGround) {
  ASSERT_TRUE(sleeps(simulator_, 0));
  simulator_.move_obstacle(0, pose_at({0.0, 0.02, 0.0}));
  simulator_.step();
  EXPECT_FALSE(sleeps(simulator_, 0));
  EXPECT_GT(simulator_.positions().row(1).minCoeff(), 0.02);
}

TEST_F(SteeredSleep, AFirstMoveFarAwayKeepsAwakeWhatAChangeWoke) {
  ASSERT_TRUE(sleeps(simulator_, 0));
  simulator_.set_gravity(Vector3::Zero());
  simulator_.move_obstacle(1, pose_at({3.1, 0.5, 0.0}));
  simulator_.step();
  EXPECT_FALSE(sleeps(simulator_, 0));
}

// A cloth sleeps on the ground. What holds its first corner lifts it by 5 cm. A rod keeps its length of about 1 m to a thousandth.
TEST(FirstMove, WakesWhatAPinAFollowerOrARodHolds) {
  Pin follower = hand({0});
  follower.obstacle = 1;
  for (const std::string holder : {"pin", "follower", "rod"}) {
    SCOPED_TRACE(holder);
    BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {4, 4}},
                                 {.structural = SpringMaterial{.value = 200.0, .damping = 0.01}, .shear = {}, .bend = {}});
    set_total_mass(shape, 0.2);
    place(shape, pose_at({0.0, 0.01, 0.0}, {-90.0, 0.0, 0.0}), Vector3::Zero());
    NetworkBuilder builder;
    builder.add_body("cloth", shape, kRough);
    const Vector3 corner = shape.positions[0];
    if (holder == "rod") {
      builder.add_attachment({.name = "rod", .particles = {0}, .second = ObstacleEnd{1}});
    } else {
      builder.add_pin(holder == "pin" ? hand({0}) : follower);
    }
    Simulator simulator(builder.build(), settings_of(), {ground(kRough), ball(corner + Vector3(0.0, 1.1, 0.0))});
    while (!sleeps(simulator, 0) && simulator.time() < 3.0) simulator.step();
    ASSERT_TRUE(sleeps(simulator, 0));
    const double height = simulator.positions()(1, 0);
    if (holder == "pin") {
      simulator.move_pin(0, shifted(simulator.pin_pose(0), {0.0, 0.05, 0.0}));
    } else {
      simulator.move_obstacle(1, shifted(simulator.obstacle_pose(1), {0.0, 0.05, 0.0}));
    }
    simulator.step();
    EXPECT_FALSE(sleeps(simulator, 0));
    EXPECT_NEAR(simulator.positions()(1, 0), height + 0.05, 1e-3);
  }
}

// Steps.

// Poses belong to the ends of steps, whatever their length; a time is rounded once.
TEST(Steering, KeepsItsPosesWhenTheStepChangesAtAFrame) {
  SimulatorSettings settings{.step = 1.0 / 900.0, .steps_per_frame = 15};
  Simulator simulator(rope({hand({0})}), settings, {ball({0.3, -0.12, 0.0})});
  double height = 0.0;
  for (const int steps_per_frame : {15, 20, 12, 40}) {
    settings.step = 1.0 / (60.0 * steps_per_frame);
    settings.steps_per_frame = steps_per_frame;
    if (simulator.state().step > 0) simulator.continue_with(simulator.model()->network(), settings);
    EXPECT_NEAR(simulator.pin_pose(0).translation().y(), height, 16.0 * kEpsilon);
    for (int k = 0; k < steps_per_frame; ++k) {
      height += 0.0005;
      simulator.move_pin(0, pose_at({0.0, height, 0.0}));
      simulator.move_obstacle(0, pose_at({0.3, height - 0.12, 0.0}));
      simulator.step();
      EXPECT_EQ(simulator.pin_pose(0).translation().y(), height);
      EXPECT_EQ(simulator.obstacle_pose(0).translation().y(), height - 0.12);
      EXPECT_NEAR(simulator.positions()(1, 0), height, 16.0 * kEpsilon);
    }
  }
}

// A move belongs to the next step, whatever its length becomes before.
TEST(Steering, AMoveTakesTheWholeOfAStepThatChanges) {
  for (const int steps_per_frame : {2, 8}) {
    SimulatorSettings settings = settings_of();
    settings.steps_per_frame = 4;
    Simulator simulator(rope({hand({0})}), settings, {ball({0.3, -0.5, 0.0})});
    run(simulator, 8 * kStep);
    simulator.move_pin(0, pose_at({0.0, 0.01, 0.0}));
    simulator.move_obstacle(0, pose_at({0.3, -0.49, 0.0}));
    settings.step = 4 * kStep / steps_per_frame;
    settings.steps_per_frame = steps_per_frame;
    simulator.continue_with(simulator.model()->network(), settings);
    EXPECT_EQ(simulator.pin_pose(0).translation(), Vector3::Zero());
    simulator.step();
    EXPECT_EQ(simulator.pin_pose(0).translation(), Vector3(0.0, 0.01, 0.0));
    EXPECT_EQ(simulator.obstacle_pose(0).translation(), Vector3(0.3, -0.49, 0.0));
    EXPECT_NEAR(simulator.positions()(1, 0), 0.01, 16.0 * kEpsilon);
  }
}

TEST(Steering, SubstepsMoveOnTheSameLine) {
  SimulatorSettings settings{.step = 0x1p-7, .stretch_limit = StretchLimitSettings{.max_stretch = 0.02}, .max_substeps = 8};
  Pin other = hand({10});
  other.name = "other";
  Simulator simulator(rope({hand({0}), other}), settings, {ball({0.5, -0.15, 0.0})});
  int most = 0;
  for (int k = 1; k <= 64; ++k) {
    simulator.move_pin(0, pose_at({0.004 * k, 0.0, 0.0}));
    simulator.move_obstacle(0, pose_at({0.5, -0.15 + 0.001 * k, 0.0}, {0.0, 0.0, 10.0 * k}));
    most = std::max(most, simulator.step().substeps);
    EXPECT_NEAR(simulator.positions()(0, 0), 0.004 * k, 16.0 * kEpsilon);
    EXPECT_EQ(simulator.obstacle_pose(0).translation(), Vector3(0.5, -0.15 + 0.001 * k, 0.0));
  }
  EXPECT_GT(most, 1);
}

/// Spoils positions when it is told to.
class Spoiler : public Constraint {
 public:
  double project(const Points& /*before*/, Points& positions, const ImpulseRecorder& /*recorder*/) const override {
    if (spoils) positions(0, 5) = kNotANumber;
    return 0.0;
  }
  [[nodiscard]] double residual(const Points& /*positions*/) const override { return 0.0; }
  bool spoils = false;
};

TEST(Steering, GoesOnAfterAStepThatDiverged) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.3, -0.3, 0.0})});
  const auto spoiler = std::make_shared<Spoiler>();
  simulator.add_constraint(spoiler);
  simulator.step();
  simulator.move_pin(0, pose_at({0.0, 0.01, 0.0}));
  simulator.move_obstacle(0, pose_at({0.3, -0.29, 0.0}));
  const SimulationState before = simulator.state();
  spoiler->spoils = true;
  EXPECT_THROW(simulator.step(), StepError);
  EXPECT_EQ(simulator.state(), before);
  EXPECT_EQ(simulator.pin_pose(0).translation(), Vector3::Zero());
  spoiler->spoils = false;
  simulator.move_obstacle(0, pose_at({0.3, -0.28, 0.0}));
  simulator.step();
  EXPECT_EQ(simulator.pin_pose(0).translation(), Vector3(0.0, 0.01, 0.0));
  EXPECT_EQ(simulator.obstacle_pose(0).translation(), Vector3(0.3, -0.28, 0.0));
}

TEST(SetGravity, BeforeTheFirstStepIsAsIfTheModelHadIt) {
  const Vector3 gravity(1.0, -3.0, 0.5);
  for (const IntegratorSettings& integrator : all_integrators()) {
    SimulatorSettings settings = settings_of();
    settings.step = integrator.index() == 0 ? 1.0e-4 : kStep;
    settings.integrator = integrator;
    settings.stability = StabilityCheck::warn;
    Simulator changed(cloth(5, 0.02, kRough), settings, {ground(kRough)});
    changed.set_gravity(gravity);
    settings.gravity = gravity;
    Simulator made(cloth(5, 0.02, kRough), settings, {ground(kRough)});
    run(changed, 0.2);
    run(made, 0.2);
    EXPECT_EQ(changed.positions(), made.positions()) << "integrator " << integrator.index();
  }
}

}  // namespace
}  // namespace sprung
