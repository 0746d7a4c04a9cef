#include "dynamics/tethers/long_range_attachments.h"

#include "base/machine/kernel.h"
#include "base/parallel.h"
#include "dynamics/networks.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "dynamics/tethers/lra_paths.h"
#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace sprung {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kFar = std::numeric_limits<double>::infinity();
const std::vector<SpringKind> kStructural{SpringKind::structural};

/// Lengths of the shortest paths along structural springs from a pin that pass no other pin, by relaxing all springs until nothing
/// changes (Bellman 1958; Ford 1956).
std::vector<double> lengths_from(const SpringNetwork& network, Index pin) {
  const Springs& springs = network.springs;
  std::vector<double> length(network.particle_count(), kFar);
  length[pin] = 0.0;
  const auto relax = [&](Index from, Index to, double rest_length) {
    if (network.is_fixed(to) || (network.is_fixed(from) && from != pin) || length[from] + rest_length >= length[to]) return false;
    length[to] = length[from] + rest_length;
    return true;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (Index s = 0; s < springs.count(); ++s) {
      if (springs.kind[s] != SpringKind::structural) continue;
      changed |= relax(springs.first[s], springs.second[s], springs.rest_length[s]);
      changed |= relax(springs.second[s], springs.first[s], springs.rest_length[s]);
    }
  }
  return length;
}

/// A tangle with three pins, apart from each other.
SpringNetwork pinned_tangle() {
  SpringNetwork network = make_random_network(300, 900);
  testing::hold(network, {.particles = {0, 100, 200}, .motion = {}});
  return network;
}

// A rope of 10 springs of 0.1 m, pinned at both ends and at particle 4. Its last pin is 0.9 m from the one before, 0.6 m along
// springs: 50 % too far. The first two are 0.3 m apart along 0.4 m.
TEST(TetherPaths, TellWhichPinsAreFarthestApartForTheirSprings) {
  NetworkBuilder builder;
  for (int i = 0; i <= 10; ++i) builder.add_particle(Vector3(0.1 * i, 0, 0), 1.0);
  for (int i = 0; i < 10; ++i) builder.add_spring(i, i + 1, 0.0, 0.1);
  builder.pin({0, 4, 10});
  const SpringNetwork network = builder.build();
  Points x = network.positions;
  x(0, 4) = 0.3;
  x(0, 10) = 1.2;
  const PinStretch found = largest_pin_stretch(find_tethers(network, kStructural), x);
  EXPECT_EQ(found.first, 4);
  EXPECT_EQ(found.second, 10);
  // The tolerances are for sums of ten lengths.
  EXPECT_NEAR(found.length, 0.6, 10 * kEpsilon);
  EXPECT_NEAR(found.stretch, 0.5, 30 * kEpsilon);
  EXPECT_EQ(largest_pin_stretch({}, x).first, kNone);
}

TEST(TetherPaths, AreTheShortestToEachPin) {
  const SpringNetwork network = pinned_tangle();
  std::vector<std::vector<double>> found(3, std::vector<double>(network.particle_count(), kFar));
  for (const Tether& tether : find_tethers(network, kStructural)) found[tether.pin / 100][tether.particle] = tether.length;
  for (const Index pin : {0, 100, 200}) {
    const std::vector<double> expected = lengths_from(network, pin);
    for (Index i = 0; i < network.particle_count(); ++i) {
      if (network.is_fixed(i) || expected[i] == kFar) {
        EXPECT_EQ(found[pin / 100][i], kFar) << i;
      } else {
        // The tolerance is for sums of at most some hundred lengths below 1, in another order.
        EXPECT_NEAR(found[pin / 100][i], expected[i], 300 * kEpsilon) << i;
      }
    }
  }
}

TEST(TetherPaths, OfAPinnedSideEndAtTheNearestPin) {
  constexpr Index kSide = 12;
  SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  for (Index i = kSide * (kSide - 1); i < kSide * kSide; ++i) network.inverse_masses[i] = 0.0;
  const std::vector<Tether> tethers = find_tethers(network, kStructural);
  ASSERT_EQ(static_cast<Index>(tethers.size()), kSide * (kSide - 1));
  for (const Tether& tether : tethers) {
    EXPECT_EQ(tether.pin, kSide * (kSide - 1) + tether.particle % kSide) << "straight above";
    const auto rows = static_cast<double>(kSide - 1 - tether.particle / kSide);
    EXPECT_NEAR(tether.length, rows / (kSide - 1), kSide * kEpsilon);
  }
}

TEST(TetherPaths, FollowOnlyLimitedSprings) {
  const SpringNetwork network = make_test_cloth(5, 0.0, 0.0);
  const auto to_the_middle = [&](const std::vector<SpringKind>& kinds) {
    const std::vector<Tether> tethers = find_tethers(network, kinds);
    return std::ranges::find(tethers, Index{12}, &Tether::particle)->length;
  };
  EXPECT_NEAR(to_the_middle(kStructural), 1.0, 8 * kEpsilon);
  EXPECT_NEAR(to_the_middle({SpringKind::structural, SpringKind::shear}), std::sqrt(0.5), 8 * kEpsilon);
}

TEST(TetherPaths, AreFewWherePinsAreMany) {
  // Spokes from one particle to many pins; the last pin is the nearest.
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);
  for (Index i = 1; i <= 9; ++i) {
    builder.add_particle(Vector3(10.0 - i, 0.0, 0.0), 1.0);
    builder.add_spring(0, i, 0.0, 10.0 - i);
    builder.pin(i);
  }
  std::vector<Index> pins;
  for (const Tether& tether : find_tethers(builder.build(), kStructural)) pins.push_back(tether.pin);
  EXPECT_THAT(pins, ::testing::ElementsAre(6, 7, 8, 9)) << "kMostTethers of them, the nearest";
}

/// Positions scaled up about the origin, far out of reach.
Points blown_up(const SpringNetwork& network) {
  Points x = 3.0 * network.positions;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_fixed(i)) x.col(i) = network.positions.col(i);
  }
  return x;
}

TEST(LongRangeAttachments, PullParticlesBackWithinReachOfAPin) {
  for (const Index side : {2, 3, 9, 70}) {
    SpringNetwork network = make_test_cloth(side, 0.0, 0.0);
    network.inverse_masses[side * (side - 1)] = 1.0;  // one pin is left
    Points x = blown_up(network);
    LongRangeAttachments(network, kStructural, 0.05).project(x);
    const std::vector<double> length = lengths_from(network, side * side - 1);
    for (Index i = 0; i + 1 < side * side; ++i) {
      const double distance = (x.col(i) - x.col(side * side - 1)).norm();
      // Coordinates and lengths are below 4 and rounded a few times each.
      EXPECT_LT(distance, 1.05 * length[i] + 32 * kEpsilon) << i;
    }
  }
}

TEST(LongRangeAttachments, PullStraightTowardsThePin) {
  SpringNetwork network = make_test_rope(40, 0.0);
  Points x = network.positions;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-3.0, 3.0);
  for (Index i = 1; i < 40; ++i) x.col(i) = Vector3(unit(random), unit(random), unit(random));
  const Points before = x;
  LongRangeAttachments(network, kStructural, 0.0).project(x);
  for (Index i = 1; i < 40; ++i) {
    const double reach = static_cast<double>(i) / 39.0;
    const double scale = std::min(1.0, reach / before.col(i).norm());
    EXPECT_LT((x.col(i) - scale * before.col(i)).norm(), 32 * kEpsilon) << i;
  }
}

TEST(LongRangeAttachments, LeaveParticlesWithinReachUnchanged) {
  const SpringNetwork network = make_test_cloth(30, 0.0, 0.0);
  Points x = network.positions;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_fixed(i)) x(2, i) = 0.005 * std::sin(i);
  }
  const Points before = x;
  // The springs of 1/29 m become 4.2 % longer when their ends differ by 0.01 m across.
  LongRangeAttachments(network, kStructural, 0.05).project(x);
  EXPECT_TRUE(x == before);
}

TEST(LongRangeAttachments, FollowPinsThatMove) {
  SpringNetwork network = make_test_rope(20, 0.0);
  Points x = network.positions;
  x.col(0) = Vector3(0.0, 5.0, 0.0);
  LongRangeAttachments(network, kStructural, 0.0).project(x);
  for (Index i = 1; i < 20; ++i) EXPECT_NEAR((x.col(i) - x.col(0)).norm(), i / 19.0, 32 * kEpsilon) << i;
}

TEST(LongRangeAttachments, DoNothingWithoutPins) {
  const SpringNetwork network = make_test_cloth(10, 0.0, 0.0, false);
  Points x = 3.0 * network.positions;
  const Points before = x;
  LongRangeAttachments(network, kStructural, 0.0).project(x);
  EXPECT_TRUE(x == before);
}

TEST(LongRangeAttachments, HaveTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork network = make_test_cloth(150, 0.0, 0.0);
  const LongRangeAttachments tethers(network, kStructural, 0.01);
  const auto project = [&](int threads) {
    const ThreadLimit at_most(threads);
    Points x = blown_up(network);
    tethers.project(x);
    return x;
  };
  const Points alone = project(1);
  EXPECT_TRUE(project(2) == alone);
  EXPECT_TRUE(project(3) == alone);
}

/// Tethers of random lengths between random positions, in every number that kernels divide differently.
struct RandomRun {
  LraRun run;
  std::vector<double> lengths;
  Points positions;
};
std::vector<RandomRun> random_runs() {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<RandomRun> runs;
  for (Index count = 1; count < 40; ++count) {
    for (const bool one_pin : {false, true}) {
      RandomRun made{.run = {.particle = 50, .pin = 3, .tether = 2, .count = count, .one_pin = one_pin},
                     .lengths = std::vector<double>(50),
                     .positions = Points(3, 100)};
      for (double& number : made.positions.reshaped()) number = unit(random);
      for (double& length : made.lengths) length = 1.0 + 0.9 * unit(random);
      runs.push_back(std::move(made));
    }
  }
  return runs;
}

TEST(LongRangeAttachments, EndAtTheirLengthAndMoveNothingElse) {
  for (const auto& [run, lengths, before] : random_runs()) {
    Points after = before;
    project_tethers_narrow(run, lengths.data(), after.data());
    for (Index i = 0; i < run.count; ++i) {
      const Vector3 from_pin = before.col(50 + i) - before.col(run.one_pin ? 3 : 3 + i);
      const double fraction = std::min(1.0, lengths[static_cast<std::size_t>(2 + i)] / from_pin.norm());
      const Vector3 expected = before.col(50 + i) - (1.0 - fraction) * from_pin;
      EXPECT_LT((after.col(50 + i) - expected).norm(), 16 * kEpsilon) << i << " of " << run.count;
    }
    after.middleCols(50, run.count) = before.middleCols(50, run.count);
    EXPECT_EQ(after, before) << "others stay";
  }
}

// On a machine with AVX-512 the chosen kernel has twice as many lanes.
TEST(LongRangeAttachments, GiveTheSameBitsWithAnyLaneCount) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this machine has no AVX-512, so both are the same code";
  for (const auto& [run, lengths, before] : random_runs()) {
    Points narrow = before;
    Points chosen = before;
    project_tethers_narrow(run, lengths.data(), narrow.data());
    project_tethers(run, lengths.data(), chosen.data());
    EXPECT_EQ(narrow, chosen);
  }
}

// A particle that hangs n springs below its pin returns in one pass, not after n^2.
TEST(StretchLimit, WithTethersEnforcesALongRopeInOnePass) {
  SpringNetwork network = make_test_rope(500, 0.0);
  network.positions.row(0) *= 1.5;
  const auto length_after = [&](bool tethers) {
    Points x = network.positions;
    StretchLimit(network, {.max_stretch = 0.0, .tethers = tethers}).project(network.positions, x);
    return x.col(499).norm();
  };
  EXPECT_NEAR(length_after(true), 1.0, 0.002) << "the last spring may move it by its own length";
  EXPECT_GT(length_after(false), 1.49);
}

}  // namespace
}  // namespace sprung
