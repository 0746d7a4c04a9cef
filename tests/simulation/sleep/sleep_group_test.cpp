// Groups divide the particles of ropes and cloths, and those that sleep change nothing but the time.
#include "simulation/sleep/sleep_group.h"

#include "base/parallel.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace sprung::testing {
namespace {

constexpr double kGap = 0.01;      // of a body and the ground [m]
constexpr double kSpacing = 0.01;  // of the particles of ropes [m]
constexpr Index kParticles = 401;

const ContactMaterial kRough{.thickness = 0.5 * kGap, .friction = 0.4, .static_friction = 0.4};

TEST(SleepGroups, EachParticleIsInOneGroupAndSpringsJoinOnlyAdjacentOnes) {
  const SpringNetwork network = cloth(20, 0.0);
  const SleepGroups groups(network);
  EXPECT_EQ(groups.count(), 7) << "the fewest of at most 64 particles";
  std::vector<Index> found;
  for (const SleepGroup& group : groups.groups) {
    EXPECT_LE(group.particles.size(), 64U);
    EXPECT_TRUE(std::ranges::includes(group.reached, group.particles));
    found.insert(found.end(), group.particles.begin(), group.particles.end());
  }
  std::ranges::sort(found);
  std::vector<Index> all(static_cast<std::size_t>(network.particle_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Index>(i);
  EXPECT_EQ(found, all);
  const std::set<GroupPair> adjacent(groups.adjacent.begin(), groups.adjacent.end());
  for (Index s = 0; s < network.springs.count(); ++s) {
    const auto [a, b] = std::minmax(groups.group_of[network.springs.first[s]], groups.group_of[network.springs.second[s]]);
    EXPECT_TRUE(a == b || adjacent.contains({a, b}));
  }
  for (const auto& triangle : network.bodies.front().surface.triangles.colwise()) {
    for (const Index corner : triangle) {
      const std::vector<Index>& reached = groups.groups[groups.group_of[corner]].reached;
      EXPECT_TRUE(std::ranges::all_of(triangle, [&](Index i) { return std::ranges::binary_search(reached, i); }));
    }
  }
}

TEST(SleepGroups, ASolidIsOneGroup) {
  BodyShape shape = make_solid({.size = {1.0, 1.0, 1.0}, .resolution = {5, 5, 5}}, {.structural = SpringMaterial{.value = 100.0}});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("solid", shape);
  builder.add_body("another", shape);
  EXPECT_EQ(SleepGroups(builder.build()).count(), 2);
}

const SimulatorSettings kWithLimit{.step = 1.0e-3, .stretch_limit = StretchLimitSettings{.max_stretch = 0.0, .tolerance = 1.0e-3}};

const SimulatorSettings kImplicit{.step = 1.0e-3, .integrator = ImplicitEulerSettings{}};

/// A rope of 4 m that lies on the ground along x, with a pin at its begin. Its bonds are as long as at rest.
Simulator lying_rope(const Motion& of_pin, bool may_sleep = true, SimulatorSettings settings = kWithLimit, double stiffness = 100.0,
                     std::vector<Obstacle> obstacles = {ground(kRough)}) {
  BodyShape rope =
      make_rope({.points = {{0.0, kGap, 0.0}, {kSpacing * (kParticles - 1), kGap, 0.0}}, .particles = kParticles, .length = {}},
                {.structural = SpringMaterial{.value = stiffness, .damping = 0.05}});
  set_total_mass(rope, 0.4);
  NetworkBuilder builder;
  builder.add_body("rope", rope, kRough);
  builder.pin(std::vector<Index>{0}, of_pin);
  settings.sleep = may_sleep;
  return Simulator(builder.build(), settings, std::move(obstacles));
}

Index sleeping(const Simulator& simulator) {
  const std::vector<char>& asleep = simulator.network().activity.asleep;
  return static_cast<Index>(std::ranges::count(asleep, 1));
}

/// The largest strain of a bond.
double strain(const Simulator& simulator) {
  const Points& x = simulator.positions();
  const auto bonds = x.rightCols(kParticles - 1) - x.leftCols(kParticles - 1);
  return bonds.colwise().norm().maxCoeff() / kSpacing - 1.0;
}

// The begin of the rope is lifted by 5 cm and put down again, for 4 s.
TEST(SleepGroups, TheEndOfARopeSleepsWhileItsBeginMoves) {
  Motion up_and_down;
  for (int k = 0; k < 9; ++k) {
    up_and_down.keyframes.push_back({.time = 0.5 * k, .position = {0.02 * (k % 2), 0.05 * (k % 2), 0.0}});
  }
  struct Result {
    Points positions;
    Vector3 force;
  };
  const auto result = [&](int threads, bool may_sleep) {
    const ThreadLimit limit(threads);
    SimulatorSettings settings = kWithLimit;
    settings.record_forces = true;
    Simulator simulator = lying_rope(up_and_down, may_sleep, settings);
    run(simulator, 3.9);
    EXPECT_EQ(sleeping(simulator) > kParticles / 2, may_sleep);
    EXPECT_FALSE(simulator.network().is_asleep(10));
    EXPECT_EQ(simulator.network().is_asleep(kParticles - 1), may_sleep);
    return Result{simulator.positions(), simulator.reactions().front().force};
  };
  const Result asleep = result(1, true);
  const Result again = result(2, true);
  EXPECT_EQ(asleep.positions, again.positions);
  EXPECT_EQ(asleep.force, again.force);
  const Result awake = result(1, false);
  // What sleeps may be as far from where it would be as what is at rest may move.
  EXPECT_LT((asleep.positions - awake.positions).colwise().norm().maxCoeff(), 2.0e-3);
  EXPECT_LT((asleep.force - awake.force).norm(), 0.02 * awake.force.norm());
}

// What wakes may have lost its support: so may the rest of its body.
TEST(SleepGroups, WhatReachesAGroupWakesAllOfTheBody) {
  const Obstacle box{.name = "box",
                     .geometry = BoxGeometry{.size = {0.1, 0.1, 0.1}},
                     .rest_pose = RigidTransform(Eigen::Translation3d(7.0, 0.065, 0.0)),
                     .motion = {.keyframes = {{.time = 0.0}, {.time = 3.0, .position = {-3.0, 0.0, 0.0}}}},
                     .material = kRough};
  Simulator simulator = lying_rope({}, true, kWithLimit, 100.0, {ground(kRough), box});
  run(simulator, 2.0);
  ASSERT_EQ(sleeping(simulator), kParticles);
  Index asleep = kParticles;
  while (simulator.time() < 3.0 && asleep == kParticles) {
    simulator.step();
    asleep = sleeping(simulator);
  }
  EXPECT_EQ(asleep, 0);
}

// The pin takes off with 3 m/s. If groups woke one by one, those awake would be stretched by 3 mm in each step. With the limit and
// with implicit Euler, all of the rope feels the pull in one step.
TEST(SleepGroups, APullWakesARopeBeforeItStretches) {
  const Motion pull{.keyframes = {{.time = 2.0}, {.time = 2.5, .position = {-1.5, 0.0, 0.0}}}};
  for (const bool limited : {true, false}) {
    Simulator simulator = limited ? lying_rope(pull) : lying_rope(pull, true, kImplicit, 1.0e5);
    Simulator awake = limited ? lying_rope(pull, false) : lying_rope(pull, false, kImplicit, 1.0e5);
    run(simulator, 1.999);
    run(awake, 1.999);
    EXPECT_GT(sleeping(simulator), kParticles / 2);
    double worst = 0.0;
    double worst_awake = 0.0;
    for (int step = 0; step < 100; ++step) {
      simulator.step();
      awake.step();
      worst = std::max(worst, strain(simulator));
      worst_awake = std::max(worst_awake, strain(awake));
    }
    EXPECT_EQ(sleeping(simulator), 0);
    EXPECT_LT(worst, worst_awake + 1.0e-3);
    EXPECT_LT((simulator.positions() - awake.positions()).colwise().norm().maxCoeff(), 2.0e-3);
  }
}

// Each step is stopped before each of its substeps, and so in its repetition with the rope awake.
TEST(SleepGroups, ARepetitionThatIsStoppedWakesNothing) {
  const Motion pull{.keyframes = {{.time = 2.0}, {.time = 2.5, .position = {-1.5, 0.0, 0.0}}}};
  Simulator simulator = lying_rope(pull, true, kImplicit, 1.0e5);
  run(simulator, 1.999);
  bool is_repeated = false;
  for (int step = 0; step < 100 && !is_repeated; ++step) {
    const std::vector<char> sleepers = simulator.state().rest.sleepers;
    bool is_complete = false;
    for (int stop = 0; !is_complete; ++stop) {
      int substep = 0;
      simulator.stop_when([&] { return substep++ == stop; });
      try {
        is_repeated = simulator.step().reason == PlanReason::wake;
        is_complete = true;
      } catch (const StoppedError&) {
        ASSERT_EQ(simulator.state().rest.sleepers, sleepers) << step << ", " << stop;
      }
    }
  }
  EXPECT_TRUE(is_repeated);
}

// The pin pulls with 0.8 mm/s, which moves no particle by the millimetre that wakes its neighbours in a window. If the rest of the
// rope stayed asleep, the two groups that are awake would be stretched by all of the 5 mm, 0.45 %. Without a limit, the
// friction of 1.6 N stretches bonds of 100 kN/m by 0.16 %, and a tenth of that more wakes the rope.
TEST(SleepGroups, ASlowPullAddsUp) {
  const Motion pull{.keyframes = {{.time = 1.0}, {.time = 7.25, .position = {-0.005, 0.0, 0.0}}}};
  for (const bool limited : {true, false}) {
    Simulator simulator = limited ? lying_rope(pull) : lying_rope(pull, true, kImplicit, 1.0e5);
    const Points before = simulator.positions();
    double worst = 0.0;
    Index most = 0;
    for (int step = 0; step < 7'250; ++step) {
      simulator.step();
      worst = std::max(worst, strain(simulator));
      most = std::max(most, sleeping(simulator));
    }
    EXPECT_GT(most, kParticles / 2);
    EXPECT_LT(worst, limited ? 1.1e-3 : 1.1 * 1.7e-3);
    EXPECT_LT((simulator.positions() - before)(0, kParticles - 1), -0.001);
  }
}

}  // namespace
}  // namespace sprung::testing
