// What counts as rest, by positions and velocities alone.
#include "simulation/sleep/rest_detector.h"

#include "simulation/scenes.h"
#include "simulation/sleep/surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace sprung::testing {
namespace {

constexpr double kWindow = 0.25;  // [s]
constexpr double kMost = 2.5e-3;  // displacement at rest on earth [m], and times four the slowest speed that is not slow

/// A cloth of 1 m whose springs of 5 cm are too long to matter, and its groups of 64 particles.
class Rest : public ::testing::Test {
 protected:
  /// Moves the particles of a group by `distance` [m] in a window, at whose end they have `speed` [m/s].
  void move(Index group, double distance, double speed = 0.0) {
    for (const Index i : groups_.groups[group].particles) {
      state_.x(0, i) += distance;
      state_.v(0, i) = speed;
    }
  }

  void end_window(const std::vector<char>& beside = {}) {
    time_ += kWindow;
    ASSERT_TRUE(RestDetector::window_ends(time_, state_));
    detector_.end_window(time_, restless_, beside.empty() ? none_ : beside, state_);
  }

  [[nodiscard]] bool rests(Index group) const { return state_.rest.histories[group].is_at_rest; }

  SpringNetwork network_ = cloth(20, 0.0);
  SleepGroups groups_{network_};
  const Vector3 gravity_ = kGravity * Vector3::UnitY();
  RestDetector detector_{network_, groups_, nullptr, gravity_};
  SimulationState state_ = initial_state(network_);
  const std::vector<char> none_ = std::vector<char>(groups_.groups.size(), 0);
  std::vector<char> restless_ = none_;
  double time_ = -kWindow;
};

TEST_F(Rest, BeginsAfterTwoQuietWindows) {
  end_window();
  EXPECT_FALSE(RestDetector::window_ends(time_ + 0.9 * kWindow, state_));
  end_window();
  EXPECT_FALSE(rests(0));
  end_window();
  EXPECT_TRUE(rests(0));
}

TEST_F(Rest, IsSlowerThanOneCentimetreASecond) {
  for (const double speed : {0.0097, 0.0099}) {  // g times a millisecond is 9.81 mm/s
    for (int window = 0; window < 3; ++window) {
      for (Index p = 0; p < groups_.count(); ++p) move(p, 0.0, speed);
      end_window();
    }
    EXPECT_EQ(rests(0), speed < 0.0098);
  }
}

TEST_F(Rest, NeedsTwoWindowsAfterTheLastRestlessOne) {
  for (int window = 0; window < 3; ++window) end_window();
  restless_[0] = 1;
  end_window();
  EXPECT_FALSE(rests(0));
  restless_[0] = 0;
  end_window();
  EXPECT_FALSE(rests(0));
  EXPECT_TRUE(rests(1));
  end_window();
  EXPECT_TRUE(rests(0));
}

// Each window is quiet on its own: less than an eighth of the largest displacement.
TEST_F(Rest, DoesNotMoveFartherAndFarther) {
  for (int window = 0; window < 3; ++window) end_window();
  for (const double distance : {0.05, 0.08, 0.11}) {
    for (Index p = 0; p < groups_.count(); ++p) move(p, distance * kMost);
    end_window();
  }
  EXPECT_TRUE(rests(0));
  for (Index p = 0; p < groups_.count(); ++p) move(p, 0.01 * kMost);
  end_window();
  for (Index p = 0; p < groups_.count(); ++p) move(p, 0.11 * kMost);
  end_window();
  EXPECT_FALSE(rests(0)) << "eleven times as far";
}

// One of seven groups moves by 0.3 of the largest displacement, the body by 0.3 / sqrt(7) = 0.113 as root mean square.
TEST_F(Rest, OfABodyAsAWholeIsThatOfAllItsGroups) {
  for (int window = 0; window < 3; ++window) {
    move(0, 0.3 * kMost);
    end_window();
  }
  EXPECT_TRUE(rests(0));
  for (int window = 0; window < 3; ++window) {
    move(0, 0.4 * kMost);
    end_window();
  }
  EXPECT_FALSE(rests(0));
  EXPECT_TRUE(rests(1));
}

TEST_F(Rest, BesideASleeperDisplacementsAddUp) {
  const std::vector<char> all(groups_.groups.size(), 1);
  for (const bool beside : {false, true}) {
    end_window();
    for (int window = 0; window < 3; ++window) {
      EXPECT_EQ(detector_.restless(state_)[0], 0);
      move(0, 0.4 * kMost);
      if (window < 2) end_window(beside ? all : none_);
    }
    EXPECT_EQ(detector_.restless(state_)[0] != 0, beside);
  }
}

// A tenth of the weight of 64 particles of 0.5 g is 31 mN; border springs of 200 N/m get it from 20 um each.
TEST_F(Rest, EndsBesideASleeperWhoseSpringsPullMore) {
  std::vector<char> asleep(static_cast<std::size_t>(network_.particle_count()), 0);
  for (const Index i : groups_.groups[0].particles) asleep[i] = 1;
  set_asleep(asleep, network_);
  const RestDetector detector(network_, groups_, nullptr, gravity_);
  detector.end_window(0.0, none_, none_, state_);
  const auto pull = [&](double distance) {  // all other particles away from the middle of the group
    Vector3 middle = Vector3::Zero();
    for (const Index i : groups_.groups[0].particles) middle += network_.positions.col(i);
    middle /= static_cast<double>(groups_.groups[0].particles.size());
    for (Index i = 0; i < network_.particle_count(); ++i) {
      if (asleep[i] == 0) state_.x.col(i) += distance * (network_.positions.col(i) - middle).normalized();
    }
    const std::vector<char> restless = detector.restless(state_);
    return std::ranges::find(restless, 1) != restless.end();
  };
  EXPECT_FALSE(pull(1.0e-7));
  EXPECT_TRUE(pull(2.0e-4));
}

// The ball is beside the middle of a face whose corners are in two groups, farther than its thickness from the boxes of both.
TEST(Surroundings, FacesBetweenGroupsReachTheirNeighbours) {
  BodyShape shape = make_cloth({.size = {19.0, 19.0}, .resolution = {20, 20}}, {.structural = SpringMaterial{.value = 100.0}});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = 0.01});
  builder.begin_body("ball", {.thickness = 0.01});
  const Index ball = builder.add_particle(Vector3::Zero(), 0.1);
  SpringNetwork network = builder.build();
  const SleepGroups groups(network);
  const ObstacleSet obstacles;
  const Vector3 gravity = kGravity * Vector3::UnitY();
  const Surroundings surroundings(network, obstacles, groups, 1.0e-3, gravity);
  SimulationState state = initial_state(network);
  int faces = 0;
  for (const auto& triangle : network.bodies.front().surface.triangles.colwise()) {
    const Index group = groups.group_of[triangle[0]];
    if (groups.group_of[triangle[1]] == group && groups.group_of[triangle[2]] == group) continue;
    ++faces;
    state.x.col(ball) = (state.x.col(triangle[0]) + state.x.col(triangle[1]) + state.x.col(triangle[2])) / 3.0;
    const std::vector<GroupPair> pairs = surroundings.find(state).pairs;
    for (const Index corner : triangle) {
      EXPECT_TRUE(std::ranges::find(pairs, GroupPair(groups.group_of[corner], groups.group_of[ball])) != pairs.end());
    }
  }
  EXPECT_GT(faces, 0);
}

// The box passes within reach from 2 s on and has left at 2.06 s, where its motion ends. At 2.25 s a window ends.
TEST(RestDetector, WhatWokeStaysAwakeForMoreThanTheWindow) {
  const ContactMaterial material{.thickness = 0.005, .friction = 0.4, .static_friction = 0.4};
  const Obstacle box{.name = "box",
                     .geometry = BoxGeometry{.size = {0.1, 0.1, 0.1}},
                     .rest_pose = RigidTransform(Eigen::Translation3d(-1.0, 0.075, 0.0)),
                     .motion = {.keyframes = {{.time = 1.96}, {.time = 2.06, .position = {2.0, 0.0, 0.0}}}},
                     .material = material};
  SimulatorSettings settings;
  settings.step = 5.0e-4;
  Simulator simulator(one_particle({0.0, 0.01, 0.0}, material), settings, {ground(material), box});
  run(simulator, 1.95);
  ASSERT_TRUE(sleeps(simulator));
  run(simulator, 0.07);
  ASSERT_FALSE(sleeps(simulator));
  run(simulator, 0.38);
  EXPECT_FALSE(sleeps(simulator));
  run(simulator, 0.4);
  EXPECT_TRUE(sleeps(simulator));
}

}  // namespace
}  // namespace sprung::testing
