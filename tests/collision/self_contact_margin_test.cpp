// How far beyond their gap contacts of the network with itself are found, and that none is missed by what is not looked at each
// step.
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.01;  // [m]
constexpr double kGap = 0.003;  // [m]

/// A sheet that rests at height 0, and a particle above it, the last.
SelfNetwork sheet_and_particle(double height) {
  SelfNetwork network;
  network.add_cloth(4, Vector3::Zero(), kEdge * Vector3::UnitX(), kEdge * Vector3::UnitZ());
  network.add_single_particle({0.0123, height, 0.0171});
  return network;
}

/// Contacts of a particle on its way down to this height [gaps] by so much [gaps]; found half a gap beyond it at most.
std::size_t contacts(double height, double fall) {
  const SelfNetwork network = sheet_and_particle((height + fall) * kGap);
  const CollisionSurface surface = network.surface(kGap);
  SelfZones zones(surface, network.positions, 0.5 * kGap);
  Points after = network.positions;
  after(1, network.count() - 1) = height * kGap;
  std::vector<Contact> found;
  zones.begin_step(network.positions, after, found);
  return found.size();
}

TEST(SelfContactMargin, OfWhatRestsIsATenthOfTheGap) {
  EXPECT_EQ(contacts(1.09, 0.0), 1U);
  EXPECT_EQ(contacts(1.11, 0.0), 0U);
}

TEST(SelfContactMargin, GrowsByHalfOfTheMotion) {
  EXPECT_EQ(contacts(1.29, 0.4), 1U);
  EXPECT_EQ(contacts(1.31, 0.4), 0U);
}

TEST(SelfContactMargin, IsNoLargerThanAsked) {
  EXPECT_EQ(contacts(1.49, 8.0), 1U);
  EXPECT_EQ(contacts(1.51, 8.0), 0U);
}

/// From 3 gaps above its own at a speed that takes it there in about `steps`; the sheet makes this part of the way.
void expect_contact_in_time(int steps, double part_of_sheet) {
  const double way = 3.1 * kGap / steps;  // [m per step]
  const SelfNetwork network = sheet_and_particle(4.0 * kGap);
  const CollisionSurface surface = network.surface(kGap);
  SelfZones zones(surface, network.positions, 0.5 * kGap);
  const Index last = network.count() - 1;
  Points x = network.positions;
  const auto height = [last](const Points& at) { return at(1, last) - at(1, 0); };
  while (height(x) > kGap) {
    Points targets = x;
    const double motion = std::min(way, height(x) - 0.5 * kGap);
    targets.row(1).head(last).array() += part_of_sheet * motion;
    targets(1, last) -= (1.0 - part_of_sheet) * motion;
    std::vector<Contact> found;
    zones.begin_step(x, targets, found);
    if (height(targets) < kGap) {
      EXPECT_EQ(found.size(), 1U) << steps << " steps, at " << height(x);
    }
    zones.hold(x, targets);
    x = targets;
  }
}

TEST(SelfContactMargin, WhatComesToASheetIsToldOfWhenItIsNearerThanItsGap) {
  for (int steps = 1; steps <= 70; ++steps) expect_contact_in_time(steps, 0.0);
}

TEST(SelfContactMargin, WhatASheetComesToIsToldOfToo) {
  for (int steps = 1; steps <= 70; ++steps) {
    expect_contact_in_time(steps, 0.5);
    expect_contact_in_time(steps, 1.0);
  }
}

/// What turns about an axis through the origin along z, and has come up at x = 1 by this.
Points turned(const Points& positions, Index count, double slope) {
  Points x = positions;
  x.row(1).head(count) += slope * x.row(0).head(count);
  return x;
}

/// The first `turning` particles turn towards the rest, of which the last is the nearest, until they are nearer than the gap;
/// `distance` is that between the two.
template <class Distance>
void expect_contact_as_it_turns(const SelfNetwork& network, Index turning, int steps, const Distance& distance) {
  const CollisionSurface surface = network.surface(kGap);
  SelfZones zones(surface, network.positions, 0.5 * kGap);
  const double slope = network.positions(1, network.count() - 1) / network.positions(0, network.count() - 1) / steps;
  Points x = network.positions;
  for (int step = 1; distance(x) > kGap; ++step) {
    Points targets = turned(network.positions, turning, step * slope);
    std::vector<Contact> found;
    zones.begin_step(x, targets, found);
    if (distance(targets) < kGap) {
      EXPECT_GT(found.size(), 0U) << steps << " steps, at " << distance(x);
    }
    zones.hold(x, targets);
    x = targets;
  }
}

// Above a face whose corners are at different heights.
TEST(SelfContactMargin, WhatASheetTurnsToIsToldOf) {
  const SelfNetwork network = sheet_and_particle(4.0 * kGap);
  const Index last = network.count() - 1;
  const auto above_the_slope = [&](const Points& x) {
    const double slope = x(1, 4) / x(0, 4);
    return (x(1, last) - slope * x(0, last)) / std::hypot(1.0, slope);
  };
  for (int steps = 5; steps <= 70; ++steps) expect_contact_as_it_turns(network, last, steps, above_the_slope);
}

// Two segments that cross at right angles: the lower one comes up by an end, or the upper one down.
TEST(SelfContactMargin, WhatARopeTurnsToIsToldOf) {
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

// What hangs above the sheet until it is let go comes faster in each step.
TEST(SelfContactMargin, WhatFallsFromRestIsToldOf) {
  for (const double gained : {0.001, 0.01, 0.1}) {
    const SelfNetwork network = sheet_and_particle(4.0 * kGap);
    const CollisionSurface surface = network.surface(kGap);
    SelfZones zones(surface, network.positions, 0.5 * kGap);
    const Index last = network.count() - 1;
    Points x = network.positions;
    for (int step = 1; x(1, last) > kGap; ++step) {
      Points targets = x;
      targets(1, last) -= std::min(step * gained * kGap, x(1, last) - 0.5 * kGap);
      std::vector<Contact> found;
      zones.begin_step(x, targets, found);
      if (targets(1, last) < kGap) {
        EXPECT_EQ(found.size(), 1U) << gained;
      }
      zones.hold(x, targets);
      x = targets;
    }
  }
}

// What goes along the sheet may turn down to it in any step, as fast as it went.
TEST(SelfContactMargin, WhatTurnsDownIsToldOf) {
  constexpr double kWay = 0.2 * kGap;  // [m per step]
  for (double height = 1.02; height < 3.0; height += 0.06) {
    const SelfNetwork network = sheet_and_particle(height * kGap);
    const CollisionSurface surface = network.surface(kGap);
    SelfZones zones(surface, network.positions, 0.5 * kGap);
    const Index last = network.count() - 1;
    Points x = network.positions;
    for (int step = 0; x(1, last) > kGap; ++step) {
      Points targets = x;
      targets(step < 5 ? 0 : 1, last) -= kWay;
      std::vector<Contact> found;
      zones.begin_step(x, targets, found);
      if (targets(1, last) < kGap) {
        EXPECT_EQ(found.size(), 1U) << "from " << height;
      }
      zones.hold(x, targets);
      x = targets;
    }
  }
}

/// A particle that stays above the sheet for long, at rest as far as contact is concerned, and then comes down is told of.
TEST(SelfContactMargin, WhatWaitedIsNotForgotten) {
  const SelfNetwork network = sheet_and_particle(1.5 * kGap);
  const CollisionSurface surface = network.surface(kGap);
  SelfZones zones(surface, network.positions, 0.5 * kGap);
  const Index last = network.count() - 1;
  Points x = network.positions;
  for (int step = 1; step <= 100; ++step) {
    Points targets = x;
    targets(1, last) -= step <= 90 ? 1.0e-4 * kGap : 0.07 * kGap;
    std::vector<Contact> found;
    zones.begin_step(x, targets, found);
    if (targets(1, last) < kGap) {
      EXPECT_EQ(found.size(), 1U) << step;
    }
    zones.hold(x, targets);
    x = targets;
  }
  EXPECT_LT(x(1, last), kGap);
}

}  // namespace
}  // namespace sprung
