// What counts as rest, by positions and velocities alone.
#include "simulation/sleep/rest_detector.h"

#include "network/set_asleep.h"
#include "simulation/scenes.h"
#include "simulation/sleep/surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace sprung::testing {
namespace {

constexpr double kWindow = 0.25;  // [s]
constexpr int kFrames = 8;        // of a window
constexpr double kMost = 2.0e-3;  // displacement of a particle at rest [m]: a tenth of its springs

/// A cloth of 20 x 20 particles with springs of 2 cm, unless they are shorter, and its groups of 64 particles.
class Rest : public ::testing::Test {
 protected:
  explicit Rest(double spring = 0.02) : network_(cloth_of_springs(spring)) {}

  /// Moves the particles of a group by `distance` [m].
  void move(Index group, double distance) {
    for (const Index i : groups_.groups[group].particles) state_.x(0, i) += distance;
  }

  /// Ends a window whose frames nobody watched.
  void end_window(const std::vector<char>& beside = {}) {
    time_ += kWindow;
    ASSERT_TRUE(RestDetector::window_ends(time_, state_));
    detector_.end_window(time_, restless_, beside.empty() ? none_ : beside, state_);
  }

  /// Lets all particles follow a path x(t) [m], t from 0 s on, for a window. Without `window` windows before, the first one begins.
  void follow(const std::function<double(double)>& path, int window) {
    constexpr int kSteps = 16 * kFrames;
    if (window == 0) end_window();
    for (int step = 1; step <= kSteps; ++step) {
      const double t = (window + static_cast<double>(step) / kSteps) * kWindow;
      for (Index i = 0; i < network_.particle_count(); ++i) state_.x(0, i) = network_.positions(0, i) + path(t);
      detector_.observe(time_ + step * kWindow / kSteps, state_);
    }
    end_window();
  }

  /// Whether a group is at rest whose particles, or a single one if not `all`, move by `distance` [m] back and forth in frames.
  bool rests_with(double distance, bool all) {
    state_ = initial_state(network_);
    for (int window = 0; window < 4; ++window) {
      end_window();
      for (int frame = 1; frame <= kFrames; ++frame) {
        const double displacement = frame % 2 == 0 ? distance : -distance;
        if (all) {
          move(0, displacement);
        } else {
          state_.x(0, groups_.groups[0].particles.front()) += displacement;
        }
        detector_.observe(time_ + frame * kWindow / kFrames, state_);
      }
    }
    end_window();
    return rests(0);
  }

  /// The time [s] at which the path is at rest for the first time; infinite: not in 20 s.
  double rests_at(const std::function<double(double)>& path) {
    state_ = initial_state(network_);
    for (Index i = 0; i < network_.particle_count(); ++i) state_.x(0, i) += path(0.0);
    for (int window = 0; window < 80; ++window) {
      follow(path, window);
      if (rests(0)) return (window + 1) * kWindow;
    }
    return std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool rests(Index group) const { return state_.rest.histories[group].is_at_rest; }

  SpringNetwork network_;
  SleepGroups groups_{network_};
  const Vector3 gravity_ = kGravity * Vector3::UnitY();
  RestDetector detector_{network_, groups_, nullptr, gravity_};
  SimulationState state_ = initial_state(network_);
  const std::vector<char> none_ = std::vector<char>(groups_.groups.size(), 0);
  std::vector<char> restless_ = none_;
  double time_ = -kWindow;

 private:
  static SpringNetwork cloth_of_springs(double length) {
    const double size = 19.0 * length;
    BodyShape shape = make_cloth({.size = {size, size}, .resolution = {20, 20}}, {.structural = SpringMaterial{.value = 200.0}});
    set_total_mass(shape, 0.2);
    NetworkBuilder builder;
    builder.add_body("cloth", shape, {.thickness = 0.005});
    return builder.build();
  }
};

class RestOfShortSprings : public Rest {
 protected:
  RestOfShortSprings() : Rest(0.005) {}
};

/// Moves by 0.08 mm in each frame.
double rocking_in_frames(double t) { return 0.04e-3 * std::cos(std::numbers::pi * kFrames / kWindow * t); }

TEST_F(Rest, BeginsAfterTwoWindowsWithoutMotion) {
  end_window();
  EXPECT_FALSE(RestDetector::window_ends(time_ + 0.9 * kWindow, state_));
  end_window();
  EXPECT_FALSE(rests(0));
  end_window();
  EXPECT_TRUE(rests(0));
}

// A motion of all particles alike that slows down by a factor of ten every second. At 0.52 mm/s, after 2.28 s, a window moves it by
// 0.52 mm/s (1 - 10^-0.25) / ln 10 = 0.1 mm.
TEST_F(Rest, BeginsWhereAWindowMovesLessThanATenthOfAMillimetre) {
  const double decay = std::log(10.0);                                              // [1/s]
  const auto path = [&](double t) { return -0.1 / decay * std::exp(-decay * t); };  // 100 mm/s at first
  EXPECT_GE(rests_at(path), 2.28);
  EXPECT_LE(rests_at(path), 2.28 + 5 * kWindow);
}

TEST_F(Rest, IsNoSteadySlideHoweverSlow) {
  for (const double speed : {1.0e-3, 1.0e-4, 1.0e-6}) {
    EXPECT_EQ(rests_at([&](double t) { return speed * t; }), std::numeric_limits<double>::infinity()) << speed;
  }
  EXPECT_LT(rests_at([&](double t) { return 1.0e-9 * t; }), 1.0) << "0.1 mm in a day";
}

// Thrown up or on a slope without friction, for a second until it turns. After 20 s it is far too fast.
TEST_F(Rest, IsNoTurnOfASteadyAcceleration) {
  for (const double acceleration : {1.0e-3, 5.0e-4, 1.1e-4}) {  // the bound is 0.1 mm/s^2
    const auto path = [&](double t) { return acceleration * (t - 0.5 * t * t); };
    EXPECT_EQ(rests_at(path), std::numeric_limits<double>::infinity()) << acceleration;
  }
}

// What begins to fall over moves by 28 nm in the first window, and by e times as much every second. It is invisible for 10 s.
TEST_F(Rest, IsNoMotionThatGrows) {
  EXPECT_EQ(rests_at([](double t) { return 1.0e-7 * std::exp(t); }), std::numeric_limits<double>::infinity());
}

// A pendulum of 0.64 m: 0.5 mm are 2 mm/s, which nobody sees in a frame.
TEST_F(Rest, IsNoSteadySwing) {
  const auto swing = [](double amplitude, double halves) {
    return [=](double t) { return amplitude * std::cos(2.0 * std::numbers::pi * t / 1.6) * std::exp2(-t / halves); };
  };
  EXPECT_EQ(rests_at(swing(0.5e-3, 100.0)), std::numeric_limits<double>::infinity());
  // 2 sin(pi 0.25 / 1.6) = 0.94 of an amplitude of 0.1 mm, after 9.3 s.
  EXPECT_LT(rests_at(swing(0.5e-3, 4.0)), 11.0) << "it dies away";
  EXPECT_LT(rests_at(swing(0.04e-3, 100.0)), 2.0) << "0.08 mm from side to side";
}

TEST_F(Rest, IsAContactThatRocksByATwentiethOfAMillimetre) {
  for (const double frequency : {1.3, 7.0, 23.0, 60.0}) {
    const auto path = [&](double t) { return 0.025e-3 * std::sin(2.0 * std::numbers::pi * frequency * t); };
    EXPECT_LT(rests_at(path), 1.5) << frequency << " Hz";
  }
}

TEST_F(Rest, IsMotionBelowATenthOfAMillimetreInAFrame) { EXPECT_LT(rests_at(rocking_in_frames), 1.5); }

// Springs of half a centimetre halve the bound of 0.1 mm.
TEST_F(RestOfShortSprings, IsMotionBelowASmallerBound) {
  EXPECT_EQ(rests_at(rocking_in_frames), std::numeric_limits<double>::infinity());
  EXPECT_LT(rests_at([](double t) { return 0.5 * rocking_in_frames(t); }), 1.5);
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

// One of seven groups swings out of sight of the others: 0.2 mm in a frame are 0.08 mm as root mean square of the body.
TEST_F(Rest, OfABodyAsAWholeIsThatOfAllItsGroups) {
  EXPECT_TRUE(rests_with(0.2e-3, true));
  EXPECT_FALSE(rests_with(0.5e-3, true));
  EXPECT_TRUE(rests(1));
}

// 1.1 mm are 0.055 mm as root mean square of 400 particles. The bound for one is 1 mm where the body as a whole is at rest.
TEST_F(Rest, IsNoMotionThatOneParticleShows) {
  EXPECT_TRUE(rests_with(0.25e-3, false));
  EXPECT_FALSE(rests_with(1.1e-3, false));
}

// A frame of 1/32 s is a multiple of their periods.
TEST_F(Rest, IsNoVibrationInStepWithFrames) {
  for (const double frequency : {32.0, 64.0, 96.0}) {
    for (const double phase : {0.0, 0.5, 1.0}) {
      const auto path = [&](double t) { return 1.0e-3 * std::cos(2.0 * std::numbers::pi * frequency * t + phase); };
      EXPECT_EQ(rests_at(path), std::numeric_limits<double>::infinity()) << frequency << " Hz";
    }
  }
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
