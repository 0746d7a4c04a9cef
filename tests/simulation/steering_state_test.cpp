// States and copies of steered simulators, and pins that a program adds.
#include "simulation/model.h"
#include "simulation/steered.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using namespace testing;
using ::testing::HasSubstr;

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

}  // namespace
}  // namespace sprung
