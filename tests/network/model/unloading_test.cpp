// Which springs break, and which of them wait for the wave of an earlier break.
#include "network/model/unloading.h"

#include "network/network_builder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kMass = 0.25;        // [kg]
constexpr double kStiffness = 100.0;  // [N/m]
constexpr double kAcross = 0.05;      // sqrt(kMass / kStiffness): a wave's time across a spring [s]

void add_chain(NetworkBuilder& builder, const std::vector<double>& places, double y = 0.0) {
  Index before = kNone;
  for (const double x : places) {
    const Index i = builder.add_particle({x, y, 0.0}, kMass);
    if (before != kNone) builder.add_spring(before, i, kStiffness, 1.0, 0.0, SpringKind::structural, {.break_length = 1.5});
    before = i;
  }
}

/// Particles on the x axis at these places; their springs have the rest length 1 m and break at 1.5 m.
SpringNetwork chain(const std::vector<double>& places) {
  NetworkBuilder builder;
  add_chain(builder, places);
  return builder.build();
}

/// A chain of springs of the same length.
SpringNetwork even_chain(Index springs, double length) {
  std::vector<double> places;
  for (Index i = 0; i <= springs; ++i) places.push_back(length * static_cast<double>(i));
  return chain(places);
}

Points at_rest(const SpringNetwork& network) { return Points::Zero(3, network.particle_count()); }

std::vector<Index> due(const SpringNetwork& network, double time, const std::vector<Unloading>& unloading) {
  return springs_due(network, network.positions, at_rest(network), time, unloading);
}

std::vector<Index> breaks(const SpringNetwork& network, double time, std::vector<Unloading>& unloading) {
  return breaking_springs(network, due(network, time, unloading), time, unloading);
}

TEST(Unloading, OfSpringsThatHangTogetherTheLongestBreaksAndTheOthersWait) {
  // Lengths of 1.75, 2, 2.25, 1.75, 1, 2 and 2: a short spring between does not part them, as the wave crosses it.
  const SpringNetwork network = chain({0.0, 1.75, 3.75, 6.0, 7.75, 8.75, 10.75, 12.75});
  EXPECT_THAT(due(network, 0.0, {}), ElementsAre(2, 1, 5, 6, 0, 3)) << "longest first, then by number";
  std::vector<Unloading> unloading;
  EXPECT_THAT(breaks(network, 0.0, unloading), ElementsAre(2));
}

TEST(Unloading, NothingIsNotedBeforeABreak) {
  std::vector<Unloading> unloading;
  EXPECT_THAT(breaks(chain({0.0, 1.5}), 0.0, unloading), IsEmpty()) << "not longer than its break length";
  EXPECT_THAT(unloading, IsEmpty());
}

TEST(Unloading, BodiesWithoutASpringBetweenThemDoNotWaitForEachOther) {
  NetworkBuilder builder;
  add_chain(builder, {0.0, 2.0, 4.0});
  add_chain(builder, {0.0, 1.75, 3.5}, 1.0);
  const SpringNetwork network = builder.build();
  std::vector<Unloading> unloading;
  EXPECT_THAT(breaks(network, 0.0, unloading), ElementsAre(0, 2));
}

TEST(Unloading, AWaveCrossesEachSpringInTheTimeOfItsMassAndStiffness) {
  NetworkBuilder builder;
  for (int i = 0; i < 4; ++i) builder.add_particle({1.0 * i, 0.0, 0.0}, kMass);
  builder.add_particle({4.0, 0.0, 0.0}, 3.0 * kMass);
  builder.add_particle({5.0, 0.0, 0.0}, kMass);
  builder.add_spring(0, 1, kStiffness, 1.0);
  builder.add_spring(1, 2, kStiffness, 1.0);
  builder.add_spring(2, 3, 4.0 * kStiffness, 1.0);
  builder.add_spring(3, 4, kStiffness, 1.0);
  const std::vector<double> times = wave_times(builder.build(), 0);
  const double heavy = kAcross * std::sqrt(2.0 / (1.0 + 1.0 / 3.0));  // the harmonic mean of m and 3 m
  const std::vector<double> expected{0.0, 0.0, kAcross, 1.5 * kAcross, 1.5 * kAcross + heavy};
  // A few roundings of times below 1 s.
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(times[i], expected[i], 8 * kEpsilon) << i;
  EXPECT_EQ(times[5], std::numeric_limits<double>::infinity()) << "no spring leads there";
}

// The first spring breaks. At the far end of the n-th spring after it, its wave arrives after n times kAcross; twice that time is
// waited. The neighbour is at the tear, and breaks then; the others break by a load beyond the recoil's.
TEST(Unloading, SpringsWaitForTheFront) {
  SpringNetwork network = even_chain(8, 1.8);  // a strain of 0.8, more than 1.5 times the break strain of 0.5
  network.positions(0, 0) = -1.0;
  std::vector<Unloading> first;
  ASSERT_THAT(breaks(network, 1.0, first), ElementsAre(0));
  for (Index s = 1; s < 8; ++s) {
    SpringNetwork other = even_chain(8, 1.2);
    other.positions.rightCols(8 - s).row(0).array() += 0.6;  // spring s alone is too long
    const double until = 1.0 + 2.0 * kAcross * static_cast<double>(s);
    // Roundings of a sum of up to 8 times.
    EXPECT_THAT(due(other, until - 32 * kEpsilon, first), IsEmpty()) << s;
    EXPECT_THAT(due(other, until + 32 * kEpsilon, first), ElementsAre(s));
  }
}

TEST(Unloading, TheRecoilBreaksNothing) {
  SpringNetwork network = even_chain(9, 1.6);
  network.positions(0, 0) = -0.1;
  std::vector<Unloading> unloading;
  ASSERT_THAT(breaks(network, 0.0, unloading), ElementsAre(0));
  SpringNetwork other = even_chain(9, 1.2);
  other.positions.rightCols(4).row(0).array() += 0.54;  // spring 5 has the strain 0.74, below 1.5 times 0.5
  const double recoil = 16.0 * 5.0 * kAcross;
  EXPECT_THAT(due(other, recoil - 64 * kEpsilon, unloading), IsEmpty());
  EXPECT_THAT(due(other, recoil + 64 * kEpsilon, unloading), ElementsAre(5));
  other.positions.rightCols(4).row(0).array() += 0.02;  // 0.76
  EXPECT_THAT(due(other, 0.5 * recoil, unloading), ElementsAre(5)) << "another load breaks it before";
}

TEST(Unloading, WhatBecomesShorterDoesNotBreakOnceSomethingBroke) {
  const SpringNetwork network = even_chain(2, 2.0);
  Points velocities = at_rest(network);
  velocities(0, 2) = -1.0;
  EXPECT_THAT(springs_due(network, network.positions, velocities, 0.0, {}), ElementsAre(0, 1)) << "before the first break it does";
  std::vector<Unloading> unloading;
  ASSERT_THAT(breaks(network, 0.0, unloading), ElementsAre(0));
  EXPECT_THAT(springs_due(network, network.positions, velocities, 1.0, unloading), ElementsAre(0));
  velocities(0, 2) = 1.0;
  EXPECT_THAT(springs_due(network, network.positions, velocities, 1.0, unloading), ElementsAre(0, 1));
}

// Both ends of a chain have lost a spring. The next ones there are at a tear, and 40 springs apart.
TEST(Unloading, TwoTearsFarApartRunAtTheSameTime) {
  SpringNetwork network = even_chain(42, 1.2);
  std::vector<Unloading> unloading;
  (void)breaking_springs(network, {0}, 0.0, unloading);
  (void)breaking_springs(network, {41}, 100.0, unloading);
  network.positions.rightCols(41).row(0).array() += 0.6;
  network.positions.rightCols(2).row(0).array() += 0.6;
  // The wave of the second break is at spring 1 after 39 times kAcross, and at spring 40 after one.
  EXPECT_THAT(breaks(network, 100.2, unloading), ElementsAre(1, 40));
}

}  // namespace
}  // namespace sprung
