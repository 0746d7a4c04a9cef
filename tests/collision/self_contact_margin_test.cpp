// How far beyond their gap contacts of the network with itself are found, and that none is missed by what is not looked at each
// step.
#include "collision/self_networks.h"

#include <gtest/gtest.h>

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
