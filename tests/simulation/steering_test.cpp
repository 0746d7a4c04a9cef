// Laws of pins and obstacles that a program moves, and of gravity that it sets.
#include "base/error.h"
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/constraints/constraint.h"
#include "simulation/model.h"
#include "simulation/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::cloth;
using testing::deforming_sheet;
using testing::ground;
using ::testing::HasSubstr;
using testing::kGravity;
using testing::run;
using testing::sleeps;

constexpr double kStep = 0x1p-10;  // [s]
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

const ContactMaterial kRough{.thickness = 0.005, .friction = 0.4, .static_friction = 0.4};

RigidTransform pose_at(const Vector3& position, const Vector3& degrees = Vector3::Zero()) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(degrees);
  pose.translation() = position;
  return pose;
}

RigidTransform shifted(RigidTransform pose, const Vector3& by) {
  pose.translation() += by;
  return pose;
}

Obstacle ball(const Vector3& position, double radius = 0.1) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = radius}, .material = kRough};
  ball.rest_pose.translation() = position;
  return ball;
}

/// 2 m below the origin.
Obstacle low_ground() {
  Obstacle low = ground(kRough);
  low.rest_pose.translation() = Vector3(0.0, -2.0, 0.0);
  return low;
}

SimulatorSettings settings_of(const Vector3& gravity = {0.0, -kGravity, 0.0}) { return {.step = kStep, .gravity = gravity}; }

/// A rope of 1 m and 11 particles from the origin along x, and pins of its ends.
SpringNetwork rope(std::vector<Pin> pins) {
  BodyShape shape = make_rope({.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, .particles = 11, .length = {}},
                              {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape, {.thickness = 0.005});
  for (Pin& pin : pins) builder.add_pin(std::move(pin));
  return builder.build();
}

Pin hand(std::vector<Index> particles, const Motion& motion = {}) {
  Pin pin;
  pin.particles = std::move(particles);
  pin.motion = motion;
  pin.name = "hand";
  return pin;
}

/// Forth and back, with a rotation; keys lie on steps.
Motion keyframes() {
  return {.keyframes = {{.time = 64 * kStep},
                        {.time = 128 * kStep, .position = {0.05, 0.1, 0.0}, .rotation = {0.0, 0.0, 30.0}},
                        {.time = 256 * kStep, .position = {0.0, 0.15, 0.1}, .rotation = {0.0, 0.0, -20.0}}}};
}

double farthest(const Simulator& a, const Simulator& b) { return (a.positions() - b.positions()).colwise().norm().maxCoeff(); }

std::string refusal(const std::function<void()>& change) {
  try {
    change();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

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
              HasSubstr("pins.hand.pose = [0, 0, 0]: cannot be given: the pin follows the obstacle \"ball\"; move the obstacle"));
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

TEST(MovePin, ChangesNothingOfAPinThatHoldsNothing) {
  Pin later = hand({0});
  later.from = 100 * kStep;
  Simulator steered(rope({later}), settings_of());
  Simulator twin(rope({later}), settings_of());
  steered.move_pin(0, pose_at({0.0, 0.1, 0.0}));
  run(steered, 50 * kStep);
  run(twin, 50 * kStep);
  EXPECT_EQ(steered.positions(), twin.positions());
  run(steered, 100 * kStep);
  run(twin, 100 * kStep);
  EXPECT_LT(farthest(twin, steered), 1e-12) << "the pin takes it where it is and stays at its pose";
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

// Copies and states.

TEST(SteeredState, ACopyGoesOnAsItsOriginal) {
  Simulator original(rope({hand({0})}), settings_of(), {ball({0.0, 3.0, 0.0})});
  original.pin({9, 10}, "other");
  for (int k = 0; k < 30; ++k) {
    original.move_pin(0, shifted(original.pin_pose(0), {0.0, 0.001, 0.0}));
    original.move_pin(1, shifted(original.pin_pose(1), {0.0, 0.0, 0.001}));
    original.move_obstacle(0, shifted(original.obstacle_pose(0), {0.0, 0.001, 0.0}));
    if (k < 29) original.step();  // the copy is made before a step that moves
  }
  Simulator copy = original;
  for (int k = 0; k < 100; ++k) {
    original.step();
    copy.step();
    ASSERT_EQ(copy.state(), original.state()) << "step " << k;
  }
  EXPECT_EQ(copy.obstacle_pose(0).matrix(), original.obstacle_pose(0).matrix());
  EXPECT_EQ(hash(copy.state()), hash(original.state()));
}

TEST(SteeredState, RestoreBringsPosesAndMovesBack) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, 3.0, 0.0})});
  const SimulationState start = simulator.state();
  const RigidTransform placed = simulator.obstacle_pose(0);
  const auto step = [&] {
    simulator.move_pin(0, shifted(simulator.pin_pose(0), {0.0, 0.002, 0.0}));
    simulator.move_obstacle(0, shifted(simulator.obstacle_pose(0), {0.0, 0.001, 0.0}));
    simulator.step();
  };
  for (int k = 0; k < 20; ++k) step();
  const SimulationState former = simulator.state();
  const RigidTransform pose = simulator.obstacle_pose(0);
  for (int k = 0; k < 20; ++k) step();
  const SimulationState later = simulator.state();
  simulator.restore(former);
  EXPECT_EQ(simulator.obstacle_pose(0).matrix(), pose.matrix());
  for (int k = 0; k < 20; ++k) step();
  EXPECT_EQ(simulator.state(), later);
  Simulator other(simulator.model());
  other.restore(former);
  EXPECT_EQ(other.obstacle_pose(0).matrix(), pose.matrix());
  EXPECT_NEAR(other.pin_pose(0).translation().y(), 20 * 0.002, 20 * kEpsilon);
  simulator.restore(start);
  EXPECT_EQ(simulator.obstacle_pose(0).matrix(), placed.matrix()) << "without steering";
  run(simulator, 4 * kStep);
  EXPECT_EQ(simulator.obstacle_pose(0).matrix(), placed.matrix());
  EXPECT_EQ(simulator.pin_pose(0).matrix(), RigidTransform::Identity().matrix());
}

TEST(SteeredState, SimulatorsOfOneModelAreSteeredInTwoThreads) {
  const std::shared_ptr<const Model> model = Model::build(rope({hand({0})}), settings_of(), {ball({0.5, -0.2, 0.0})});
  std::vector<Points> ends(2);
  std::vector<std::thread> threads;
  for (Points& end : ends) {
    threads.emplace_back([&] {
      Simulator simulator(model);
      for (int k = 0; k < 100; ++k) {
        simulator.move_obstacle(0, shifted(simulator.obstacle_pose(0), {0.0, 0.002, 0.0}));
        simulator.move_pin(0, shifted(simulator.pin_pose(0), {0.0, 0.001, 0.0}));
        simulator.step();
      }
      end = simulator.positions();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(model->obstacles().obstacle(0).rest_pose.translation(), Vector3(0.5, -0.2, 0.0));
}

// Pins of a program.

TEST(AddedPin, ItsReactionHasItsName) {
  SimulatorSettings settings = settings_of();
  settings.record_forces = true;
  Simulator simulator(rope({hand({0})}), settings);
  const std::size_t number = simulator.pin({9, 10}, "gripper");
  EXPECT_EQ(number, 1U);
  EXPECT_EQ(simulator.network().pins[number].name, "gripper");
  EXPECT_EQ(simulator.pin_pose(number).translation(), Vector3(0.95, 0.0, 0.0)) << "the mean of its particles";
  run(simulator, 40.0);
  simulator.reset_forces();
  run(simulator, 1.0);
  const std::vector<Reaction> reactions = simulator.reactions();
  ASSERT_EQ(reactions.size(), 2U);
  EXPECT_EQ(reactions[0].name, "hand");
  EXPECT_EQ(reactions[1].name, "gripper");
  // Dampers have stopped what changes the length of springs; both pins carry the weight, which swings a little.
  EXPECT_NEAR(reactions[0].force.y() + reactions[1].force.y(), 0.1 * kGravity, 0.01 * 0.1 * kGravity);
}

TEST(AddedPin, ASecondOneOfItsNameEndsIt) {
  Simulator simulator(rope({hand({0})}), settings_of());
  const std::size_t number = simulator.pin({9, 10}, "gripper");
  simulator.move_pin(number, shifted(simulator.pin_pose(number), {0.0, 0.01, 0.0}));
  simulator.step();
  EXPECT_EQ(simulator.pin({8, 9}, "gripper"), number);
  EXPECT_FALSE(simulator.network().is_pinned(10)) << "it goes free";
  EXPECT_TRUE(simulator.network().is_pinned(9));
  EXPECT_TRUE(simulator.network().is_pinned(8));
  const Vector3 mean = 0.5 * (simulator.positions().col(8) + simulator.positions().col(9));
  EXPECT_EQ(simulator.pin_pose(number).translation(), mean);
  const Points held = simulator.positions().middleCols(8, 2);
  run(simulator, 20 * kStep);
  EXPECT_EQ(simulator.positions().middleCols(8, 2), held);
}

TEST(AddedPin, LeavesOutWhatIsPinned) {
  Simulator simulator(rope({hand({0})}), settings_of());
  const std::size_t number = simulator.pin({0, 1, 10}, "both");
  EXPECT_EQ(simulator.state().activity.pin_of[0], 0);
  EXPECT_EQ(simulator.state().activity.pin_of[1], static_cast<Index>(number));
  EXPECT_EQ(simulator.pin(0), 0U) << "the pin that holds it";
  simulator.move_pin(number, shifted(simulator.pin_pose(number), {0.0, 0.01, 0.0}));
  simulator.step();
  EXPECT_EQ(simulator.positions().col(0), Vector3::Zero());
  EXPECT_NEAR(simulator.positions()(1, 10), 0.01, 4.0 * kEpsilon);
}

TEST(AddedPin, GoesOnInAChangedModel) {
  Simulator simulator(rope({hand({0})}), settings_of());
  const std::size_t number = simulator.pin({10}, "gripper");
  for (int k = 0; k < 10; ++k) {
    simulator.move_pin(number, shifted(simulator.pin_pose(number), {0.0, 0.001, 0.0}));
    simulator.step();
  }
  simulator.set_springs(0, SpringKind::structural, 50.0, 0.1);
  EXPECT_NEAR(simulator.pin_pose(number).translation().y(), 0.01, 16.0 * kEpsilon);
  simulator.move_pin(number, shifted(simulator.pin_pose(number), {0.0, 0.001, 0.0}));
  simulator.step();
  EXPECT_NEAR(simulator.positions()(1, 10), 0.011, 16.0 * kEpsilon);
}

TEST(MovePin, GoesOnInAModelWithOtherPins) {
  const SpringNetwork network = rope({hand({0})});
  Pin foot = hand({10});
  foot.name = "foot";
  const SpringNetwork with_foot = rope({foot, hand({0})});
  Simulator simulator(network, settings_of());
  const std::size_t added = simulator.pin({5}, "gripper");
  for (int k = 1; k <= 20; ++k) {
    simulator.move_pin(0, pose_at({0.0, 0.002 * k, 0.0}));
    simulator.move_pin(added, shifted(simulator.pin_pose(added), {0.0, 0.001, 0.0}));
    simulator.step();
  }
  const Points positions = simulator.positions();
  simulator.continue_with(with_foot, simulator.settings());
  EXPECT_EQ(simulator.positions(), positions);
  EXPECT_EQ(simulator.pin_pose(1).translation(), Vector3(0.0, 0.04, 0.0));
  EXPECT_EQ(simulator.network().pins[2].name, "gripper");
  simulator.move_pin(1, pose_at({0.0, 0.042, 0.0}));
  simulator.move_pin(2, shifted(simulator.pin_pose(2), {0.0, 0.001, 0.0}));
  simulator.step();
  EXPECT_NEAR(simulator.positions()(1, 0), 0.042, 32.0 * kEpsilon);
  EXPECT_NEAR(simulator.positions()(1, 5), 0.021, 32.0 * kEpsilon);
  EXPECT_EQ(simulator.positions().col(10), positions.col(10)) << "the new pin takes it where it is";
}

// Forces belong to names, whatever the numbers of the pins.
TEST(MovePin, ForcesGoOnInAModelWithOtherPins) {
  const auto named = [](const char* name, Index particle) {
    Pin pin = hand({particle});
    pin.name = name;
    return pin;
  };
  SimulatorSettings settings = settings_of();
  settings.record_forces = true;
  Simulator simulator(rope({named("left", 0), named("right", 10), named("middle", 5)}), settings);
  simulator.pin({2}, "gripper");
  run(simulator, 100 * kStep);
  std::map<std::string, Vector3> before;
  for (const Reaction& reaction : simulator.reactions()) before[reaction.name] = reaction.force;
  simulator.continue_with(rope({named("middle", 5), named("left", 0)}), simulator.settings());
  const std::vector<Reaction> after = simulator.reactions();
  ASSERT_EQ(after.size(), 3U);
  for (const Reaction& reaction : after) EXPECT_EQ(reaction.force, before.at(reaction.name)) << reaction.name;
  EXPECT_NE(before.at("left"), before.at("middle"));
}

TEST(AddedPin, OfOneParticleEndsNoOther) {
  Simulator simulator(rope({hand({0})}), settings_of());
  const std::size_t other = simulator.pin({4}, "rope.particles[3]");
  const std::size_t number = simulator.pin(3);
  EXPECT_NE(number, other);
  EXPECT_TRUE(simulator.network().is_pinned(4));
  EXPECT_TRUE(simulator.network().is_pinned(3));
  simulator.release(3);
  EXPECT_EQ(simulator.pin(3), number) << "its own former pin begins again";
}

TEST(AddedPin, ItsNameIsNotThatOfAPinOfAChangedModel) {
  Simulator simulator(rope({}), settings_of());
  simulator.pin({5}, "hand");
  EXPECT_THAT(refusal([&] { simulator.continue_with(rope({hand({0})}), simulator.settings()); }),
              HasSubstr("pins.hand: is the name of a pin that the program added"));
  simulator.step();
}

TEST(AddedPin, MayHoldAllParticles) {
  Simulator simulator(rope({}), settings_of(), {low_ground()});
  std::vector<Index> all;
  for (Index i = 0; i < 11; ++i) all.push_back(i);
  const std::size_t number = simulator.pin(all, "all");
  const Points start = simulator.positions();
  for (int k = 1; k <= 100; ++k) {
    simulator.move_pin(number, pose_at({0.5, 0.001 * k, 0.0}));
    simulator.step();
  }
  EXPECT_LT((simulator.positions() - (start.colwise() + Vector3(0.0, 0.1, 0.0))).cwiseAbs().maxCoeff(), 16.0 * kEpsilon);
  simulator.release(3);
  run(simulator, 50 * kStep);
  EXPECT_GT(simulator.positions()(1, 3), 0.1) << "it goes on upwards";
  EXPECT_LT(simulator.positions()(1, 3), 0.1 + 50 * 0.001);
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

// Refusals.

TEST(MoveObstacle, GoesNoFartherInAStepThanTheLargestBodyIsLarge) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, -0.5, 0.0}), low_ground()});
  EXPECT_EQ(
      refusal([&] {
        simulator.move_obstacle(0, pose_at({2.5, -0.5, 0.0}));
      }),
      "obstacles.ball.pose = 2.5 m from the present pose: must be at most 1 m away in one step, the size of the largest body; "
      "go there in 3 steps");
  for (int k = 1; k <= 3; ++k) {
    simulator.move_obstacle(0, pose_at({2.5 * k / 3.0, -0.5, 0.0}));
    simulator.step();
  }
  EXPECT_EQ(refusal([&] {
              simulator.move_pin(0, pose_at({0.0, 0.0, 1.5}));
            }),
            "pins.hand.pose = 1.5 m from the present pose: must be at most 1 m away in one step, the size of the largest body; "
            "go there in 2 steps");
  simulator.move_pin(0, pose_at({0.0, 0.0, 1.0}));
  // A rotation moves points as far as they are from the origin: this one by pi / 2 times 0.1 sqrt(3).
  simulator.move_obstacle(0, pose_at({2.5, -0.5, 0.0}, {0.0, 90.0, 0.0}));
  EXPECT_EQ(refusal([&] {
              simulator.move_obstacle(0, pose_at({3.3, -0.5, 0.0}, {0.0, 90.0, 0.0}));
            }),
            "obstacles.ball.pose = 1.07207 m from the present pose: must be at most 1 m away in one step, the size of the largest "
            "body; go there in 2 steps");
  simulator.move_obstacle(1, pose_at({0.0, -2.9, 0.0}, {10.0, 0.0, 0.0}));  // a half-space has no farthest point
}

TEST(Steering, RefusesWhatItCannotDo) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, -0.5, 0.0})});
  const auto pose_of = [](const std::function<void(RigidTransform&)>& change) {
    RigidTransform pose = RigidTransform::Identity();
    change(pose);
    return pose;
  };
  const std::vector<std::pair<RigidTransform, std::string>> poses{
      {pose_of([](RigidTransform& pose) { pose.translation().y() = kNotANumber; }),
       "= [0, nan, 0]: must be finite; give a position"},
      {pose_of([](RigidTransform& pose) { pose.translation().z() = -std::numeric_limits<double>::infinity(); }), "= [0, 0, -inf]"},
      {pose_of([](RigidTransform& pose) { pose.linear()(1, 2) = kNotANumber; }), "= a rotation that is not finite"},
      {pose_of([](RigidTransform& pose) { pose.linear() *= 2.0; }), "= a matrix R with |R^T R - I| = 5.2: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear().setZero(); }), "= a matrix R with |R^T R - I| = 1.73: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear()(0, 0) = -1.0; }), "= a reflection: must be a rotation"},
      {pose_of([](RigidTransform& pose) { pose.linear()(0, 1) = 0.5; }),
       "= a matrix R with |R^T R - I| = 0.75: must be a rotation"}};
  const SimulationState before = simulator.state();
  for (const auto& [pose, says] : poses) {
    EXPECT_THAT(refusal([&, &its = pose] { simulator.move_pin(0, its); }), HasSubstr("pins.hand.pose " + says));
    EXPECT_THAT(refusal([&, &its = pose] { simulator.move_obstacle(0, its); }), HasSubstr("obstacles.ball.pose " + says));
  }
  const auto expect = [&](const std::function<void()>& change, const std::string& says) {
    EXPECT_THAT(refusal(change), HasSubstr(says));
  };
  expect([&] { simulator.move_pin(1, RigidTransform::Identity()); }, "pins = 1: there are only 1; count from 0");
  expect([&] { simulator.move_obstacle(7, RigidTransform::Identity()); }, "obstacles = 7: there are only 1; count from 0");
  expect([&] { (void)simulator.pin_pose(1); }, "pins = 1");
  expect([&] { (void)simulator.obstacle_pose(1); }, "obstacles = 1");
  expect([&] { simulator.pin(11); }, "particle = 11: must be the number of a particle; there are 11; count particles from 0");
  expect([&] { simulator.pin(-1); }, "particle = -1");
  expect([&] { simulator.release(11); }, "particle = 11");
  expect([&] { simulator.release(kNone); }, "particle = -1");
  expect([&] { simulator.pin({}, "x"); }, "pins.x: must contain at least one particle; name a particle");
  expect([&] { simulator.pin({3, 99}, "x"); }, "pins.x[1] = 99: must be the number of a particle; there are 11");
  expect([&] { simulator.pin({3, 4, 3}, "x"); }, "pins.x = 3: must be named once; remove the second one");
  expect([&] { simulator.pin({3}, ""); }, "must be a name, which its reaction has too; name the pin");
  expect([&] { simulator.pin({3}, "hand"); }, "pins.hand: is the name of a pin of the network already; choose another name");
  expect([&] { simulator.set_gravity({0.0, kNotANumber, 0.0}); }, "gravity");
  EXPECT_EQ(simulator.state(), before);
}

TEST(Steering, AStateWithPosesThatDoNotFitIsRefused) {
  Simulator simulator(rope({hand({0})}), settings_of(), {ball({0.0, -0.5, 0.0})});
  simulator.step();
  simulator.move_pin(0, pose_at({0.0, 0.1, 0.0}));
  simulator.move_obstacle(0, pose_at({0.0, -0.4, 0.0}));
  simulator.pin({10}, "other");
  simulator.move_pin(1, shifted(simulator.pin_pose(1), {0.0, 0.1, 0.0}));
  const SimulationState state = simulator.state();
  using Change = std::function<void(SimulationState&)>;
  const std::vector<std::pair<std::string, Change>> faults{
      {"state.steering.pins", [](SimulationState& s) { s.steering.pins[0].number = 5; }},
      {"state.steering.pins", [](SimulationState& s) { s.steering.pins[1].number = 0; }},
      {"state.steering.pins", [](SimulationState& s) { s.steering.pins[0].poses.clear(); }},
      {"state.steering.pins", [](SimulationState& s) { s.steering.pins[0].poses[1].time = -1.0; }},
      {"state.steering.pins", [](SimulationState& s) { s.steering.pins[0].poses[1].pose.linear() *= 2.0; }},
      {"state.steering.obstacles", [](SimulationState& s) { s.steering.obstacles[0].number = 1; }},
      {"state.steering.obstacles",
       [](SimulationState& s) { s.steering.obstacles[0].poses[0].pose.translation().x() = kNotANumber; }},
      {"state.steering.added_pins", [](SimulationState& s) { s.steering.added_pins[0].particles = {99}; }}};
  for (const auto& [says, change] : faults) {
    SimulationState spoiled = state;
    change(spoiled);
    EXPECT_THAT(refusal([&, &wrong = spoiled] { simulator.restore(wrong); }), HasSubstr(says));
    EXPECT_EQ(simulator.state(), state);
  }
  Simulator other(rope({}), settings_of());
  EXPECT_THAT(refusal([&] { other.restore(state); }), HasSubstr("state.steering.obstacles"));
}

}  // namespace
}  // namespace sprung
