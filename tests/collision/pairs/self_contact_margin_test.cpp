// The margin beyond the gap within which contacts of the network with itself are found. None may be missed because a candidate was
// skipped in a step.
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.01;  // [m]
constexpr double kGap = 0.003;  // [m]

/// A sheet at rest at height 0, and a particle above it, which is the last.
SelfNetwork sheet_and_particle(double height) {
  SelfNetwork network;
  network.add_cloth(4, Vector3::Zero(), kEdge * Vector3::UnitX(), kEdge * Vector3::UnitZ());
  network.add_single_particle({0.0123, height, 0.0171});
  return network;
}

/// Number of contacts found as a particle falls by `fall` [gaps] to this height [gaps]. They are found at most half a gap beyond
/// the gap.
std::size_t contacts(double height, double fall) {
  const SelfNetwork network = sheet_and_particle((height + fall) * kGap);
  const CollisionSurface surface = network.surface(kGap);
  PairSeparation separation(surface, network.positions, 0.5 * kGap);
  Points after = network.positions;
  after(1, network.count() - 1) = height * kGap;
  std::vector<Contact> found;
  separation.begin_step(network.positions, after, found);
  return found.size();
}

/// The largest height [gaps] above 1, in steps of a hundredth, at which contact is found after this fall [gaps].
double reach(double fall) {
  double height = 0.99;
  while (contacts(height + 0.01, fall) > 0) height += 0.01;
  return height;
}

TEST(SelfContactMargin, IsPositiveAndLessThanAskedAtRest) {
  EXPECT_GT(reach(0.0), 1.0);
  EXPECT_LT(reach(0.0), 1.45);
}

TEST(SelfContactMargin, GrowsWithTheMotionUpToTheAskedMargin) {
  EXPECT_GT(reach(0.2), reach(0.0));
  EXPECT_GT(reach(0.4), reach(0.2));
  EXPECT_NEAR(reach(8.0), 1.5, 0.011);
  EXPECT_EQ(reach(80.0), reach(8.0));
}

/// Makes steps to the positions `go(step, before)`, with steps counted from 0, until two sides are nearer than the gap. The step
/// in which that happens has to find one contact. `distance` is the distance of the sides [m].
template <class Go, class Distance>
void expect_contact_in_time(const SelfNetwork& network, const Go& go, const Distance& distance) {
  const CollisionSurface surface = network.surface(kGap);
  PairSeparation separation(surface, network.positions, 0.5 * kGap);
  Points x = network.positions;
  for (int step = 0; distance(x) > kGap; ++step) {
    Points targets = go(step, x);
    std::vector<Contact> found;
    separation.begin_step(x, targets, found);
    if (distance(targets) < kGap) {
      EXPECT_EQ(found.size(), 1U) << "in step " << step << ", from " << distance(x);
    }
    separation.constrain(x, targets);
    x = targets;
  }
}

/// Height of the last particle above the first.
double height(const Points& x) { return x(1, x.cols() - 1) - x(1, 0); }

/// The particle falls from 3 gaps above its gap, at a speed that closes the distance in about `steps`; the sheet moves by the
/// fraction `sheet_fraction` of it.
void expect_contact_as_they_approach(int steps, double sheet_fraction) {
  SCOPED_TRACE(std::to_string(steps) + " steps");
  const auto go = [&](int, const Points& x) {
    const double motion = std::min(3.1 * kGap / steps, height(x) - 0.5 * kGap);
    Points targets = x;
    targets.row(1).array() += sheet_fraction * motion;
    targets(1, x.cols() - 1) -= motion;
    return targets;
  };
  expect_contact_in_time(sheet_and_particle(4.0 * kGap), go, height);
}

TEST(SelfContactMargin, AParticleNearerToASheetThanItsGapIsReported) {
  for (int steps = 1; steps <= 70; ++steps) expect_contact_as_they_approach(steps, 0.0);
}

TEST(SelfContactMargin, AParticleThatASheetApproachesIsReported) {
  for (int steps = 1; steps <= 70; ++steps) {
    expect_contact_as_they_approach(steps, 0.5);
    expect_contact_as_they_approach(steps, 1.0);
  }
}

/// The first `turning` particles rotate about the z axis towards the others, of which the last is the nearest, and reach it in
/// this many steps.
template <class Distance>
void expect_contact_as_it_turns(const SelfNetwork& network, Index turning, int steps, const Distance& distance) {
  SCOPED_TRACE(std::to_string(steps) + " steps");
  const Vector3 last = network.positions.col(network.count() - 1);
  const auto go = [&](int step, const Points&) {
    Points targets = network.positions;
    targets.row(1).head(turning) += (step + 1) * last.y() / last.x() / steps * targets.row(0).head(turning);
    return targets;
  };
  expect_contact_in_time(network, go, distance);
}

// Above a face whose corners are at different heights.
TEST(SelfContactMargin, AParticleThatASheetRotatesTowardsIsReported) {
  const SelfNetwork network = sheet_and_particle(4.0 * kGap);
  const Index last = network.count() - 1;
  const auto above_the_slope = [&](const Points& x) {
    const double slope = x(1, 4) / x(0, 4);
    return (x(1, last) - slope * x(0, last)) / std::hypot(1.0, slope);
  };
  for (int steps = 5; steps <= 70; ++steps) expect_contact_as_it_turns(network, last, steps, above_the_slope);
}

// Two segments that cross at right angles: the lower one comes up by an end, or the upper one down.
TEST(SelfContactMargin, AParticleThatARopeRotatesTowardsIsReported) {
  const auto apart = [](const Points& x) {
    const double slope = (x(1, 1) - x(1, 0)) / (x(0, 1) - x(0, 0));
    return (x(1, 2) - x(1, 0) - slope * (x(0, 2) - x(0, 0))) / std::hypot(1.0, slope);
  };
  for (const double sign : {1.0, -1.0}) {
    SelfNetwork network;
    network.add_rope(1, Vector3::Zero(), 0.02 * Vector3::UnitX());
    network.add_rope(1, {0.015, sign * 4.0 * kGap, -0.01}, 0.02 * Vector3::UnitZ());
    for (int steps = 5; steps <= 70; ++steps) {
      expect_contact_as_it_turns(network, 2, steps, [&](const Points& x) { return sign * apart(x); });
    }
  }
}

/// The particle moves as `move(step)` says [gaps], from this height [gaps].
template <class Move>
void expect_contact_on_its_path(double from, const Move& move) {
  SCOPED_TRACE("from " + std::to_string(from));
  const auto go = [&](int step, const Points& x) {
    Points targets = x;
    targets.rightCols(1) += kGap * move(step);
    targets(1, x.cols() - 1) = std::max(targets(1, x.cols() - 1), 0.5 * kGap);
    return targets;
  };
  expect_contact_in_time(sheet_and_particle(from * kGap), go, height);
}

// A particle that is released above the sheet moves faster in each step.
TEST(SelfContactMargin, AParticleThatFallsFromRestIsReported) {
  for (const double gained : {0.001, 0.01, 0.1}) {
    expect_contact_on_its_path(4.0, [&](int step) { return Vector3(0.0, -(step + 1) * gained, 0.0); });
  }
}

// An element that moves along the sheet may rotate down to it in any step, as fast as it moved.
TEST(SelfContactMargin, AnElementThatRotatesDownIsReported) {
  for (double from = 1.02; from < 3.0; from += 0.06) {
    expect_contact_on_its_path(from, [](int step) -> Vector3 { return -0.2 * (step < 5 ? Vector3::UnitX() : Vector3::UnitY()); });
  }
}

/// Each particle rises by `rise` times a small fraction of the gap, once the spheres are set.
Points creep(const Points& x, int step, const Scalars& rise) {
  Points targets = x;
  if (step > 0) targets.row(1) += 0.03 * kGap * rise.transpose();
  return targets;
}

// While no particle leaves its sphere, the list is not renewed. So it has to cover the motion of both particles within their
// spheres.
TEST(SelfContactMargin, SurfacesThatCreepTogetherAreReported) {
  const SelfNetwork network = sheet_and_particle(1.55 * kGap);
  Scalars rise = Scalars::Ones(network.count());
  rise(network.count() - 1) = -1.0;
  expect_contact_in_time(
      network, [&](int step, const Points& x) { return creep(x, step, rise); }, height);
}

// The end of a long segment has a larger sphere than the end that it shares with a short one.
TEST(SelfContactMargin, EndsThatCreepTogetherAreReported) {
  SelfNetwork network;
  network.add_rope(2, Vector3::Zero(), 0.04 * Vector3::UnitX());
  network.positions(0, 1) = 0.005;
  network.add_rope(1, {0.0799, 2.55 * kGap, -0.01}, 0.02 * Vector3::UnitZ());
  Scalars rise = Scalars::Zero(network.count());
  rise << 0.0, 0.0, 2.0, -1.0, -1.0;
  const auto apart = [](const Points& x) { return x(1, 3) - x(1, 2); };
  expect_contact_in_time(
      network, [&](int step, const Points& x) { return creep(x, step, rise); }, apart);
}

// Of two elements that fly together one may be stopped in any step, while no particle leaves its sphere.
TEST(SelfContactMargin, AnElementThatStopsIsReported) {
  for (int stop = 1; stop <= 8; ++stop) {
    SCOPED_TRACE("stops in step " + std::to_string(stop));
    const auto go = [&](int step, const Points& x) {
      Points targets = x;
      if (step < stop) targets.row(1).array() -= 0.1 * kGap;
      if (step >= stop) targets(1, x.cols() - 1) -= 0.1 * kGap;
      return targets;
    };
    expect_contact_in_time(sheet_and_particle(1.18 * kGap), go, height);
  }
}

// Either of two crossed segments moves, the other rests.
TEST(SelfContactMargin, AParticleThatFallsAcrossAnEdgeIsReported) {
  for (const Index falling : {0, 2}) {
    SelfNetwork network;
    network.add_rope(1, {-0.01, 0.0, 0.0}, 0.02 * Vector3::UnitX());
    network.add_rope(1, {0.0, 4.0 * kGap, -0.01}, 0.02 * Vector3::UnitZ());
    const auto go = [&](int step, const Points& x) {
      const double motion = std::min((step + 1) * 0.01 * kGap, height(x) - 0.5 * kGap);
      Points targets = x;
      targets.row(1).segment(falling, 2).array() += falling == 0 ? motion : -motion;
      return targets;
    };
    expect_contact_in_time(network, go, height);
  }
}

// Solver passes and obstacles move particles to other positions than forces did. The next step has to search for what is near
// there, even if another particle leaves its sphere in that step.
TEST(SelfContactMargin, AParticleMovedThereByPassesIsReported) {
  SelfNetwork network = sheet_and_particle(2.3 * kGap);
  network.add_single_particle({0.5, 0.5, 0.5});
  const Index moved = network.count() - 2;
  const Points above = network.positions;
  network.positions(1, moved) = 4.0 * kGap;
  const CollisionSurface surface = network.surface(kGap);
  PairSeparation separation(surface, network.positions, 0.5 * kGap);
  std::vector<Contact> found;
  separation.begin_step(network.positions, network.positions, found);
  separation.constrain(network.positions, above);
  ASSERT_TRUE(found.empty());
  Points targets = above;
  targets(1, moved) = 0.9 * kGap;
  targets(0, moved + 1) += 1.0;
  separation.begin_step(above, targets, found);
  EXPECT_EQ(found.size(), 1U);
}

// One end of a segment above the sheet leaves its sphere, the other does not.
TEST(SelfContactMargin, AParticleThatStaysIsReportedOnce) {
  SelfNetwork network = sheet_and_particle(100.0 * kGap);
  network.add_rope(1, {0.0123, 0.9 * kGap, 0.0171}, {0.011, 0.0, 0.004});
  const CollisionSurface surface = network.surface(kGap);
  PairSeparation separation(surface, network.positions, 0.5 * kGap);
  std::vector<Contact> found;
  separation.begin_step(network.positions, network.positions, found);
  EXPECT_EQ(found.size(), 2U);
  Points targets = network.positions;
  targets(0, network.count() - 1) += 0.5 * kGap;
  found.clear();
  separation.begin_step(network.positions, targets, found);
  EXPECT_EQ(found.size(), 2U);
}

// A candidate that rests above the sheet for some steps, and is skipped in them, is checked again.
TEST(SelfContactMargin, AParticleThatWaitedIsReported) {
  expect_contact_on_its_path(1.5, [](int step) { return Vector3(0.0, step < 90 ? -1.0e-4 : -0.07, 0.0); });
}

}  // namespace
}  // namespace sprung
