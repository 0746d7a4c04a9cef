#include "dynamics/two_level_newton.h"

#include "dynamics/networks.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sprung {
namespace {

constexpr double kGravity = 9.81;
constexpr double kStep = 1.0 / 60.0;
constexpr double kFall = kGravity * kStep * kStep;
constexpr Index kSide = 32;
const StretchLimitSettings kLimit{.max_stretch = 0.0, .tolerance = 0.01};

StretchComponent component_of(const SpringNetwork& network) { return stretch_components(network, kLimit.kinds).front(); }

TwoLevelNewton two_levels(const SpringNetwork& network) {
  const StretchComponent component = component_of(network);
  return {component, *coarsen(network, component, kLimit.kinds), kLimit};
}

/// Steps of a network that limits alone hold, from rest.
class Fall {
 public:
  Fall(const SpringNetwork& network, ComponentSolver& solver) : x(network.positions), network_(network), solver_(solver) {}

  std::optional<int> step() {
    Points led = x;
    for (Index i = 0; i < network_.particle_count(); ++i) {
      if (!network_.is_pinned(i)) led.col(i) += kStep * v.col(i) - kFall * Vector3::UnitY();
    }
    const auto solves = solver_.solve(x, led, kFall);
    v = (led - x) / kStep;
    x = led;
    return solves;
  }

  Points x;
  Points v = Points::Zero(3, x.cols());

 private:
  const SpringNetwork& network_;
  ComponentSolver& solver_;
};

double mean_height(const Points& x) { return x.row(1).mean(); }

TEST(CoarseCloth, HasAQuarterOfTheParticlesAndAllOfTheMass) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0, false);
  const StretchComponent fine = component_of(network);
  const auto cloth = coarsen(network, fine, kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_EQ(cloth->particles.size(), fine.points.size() / 4);
  const std::vector<double>& masses = cloth->component.masses;
  EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), network.masses.sum(), 1e-14 * network.masses.sum());
  // Along rows and columns: what limits no shear gets no links across cells.
  EXPECT_EQ(cloth->component.links.size(), 2 * (kSide / 2) * (kSide / 2 - 1));
}

// What lies between corners of a flat cloth is their mean by its weights, and a link is as long as the springs along it.
TEST(CoarseCloth, LiesWhereTheClothDoes) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  const StretchComponent fine = component_of(network);
  const auto cloth = coarsen(network, fine, {SpringKind::structural, SpringKind::shear});
  ASSERT_TRUE(cloth);
  for (Index n = 0; n < fine.free_count; ++n) {
    Vector3 mean = Vector3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      mean += cloth->places[n].weights[k] * network.positions.col(cloth->particles[cloth->places[n].points[k]]);
    }
    EXPECT_NEAR((mean - network.positions.col(fine.points[n])).norm(), 0.0, 1e-14);
  }
  const auto at = [&](Index point) -> Vector3 { return network.positions.col(cloth->particles[cloth->component.points[point]]); };
  for (const StretchComponent::Link& link : cloth->component.links) {
    EXPECT_NEAR((at(link.second) - at(link.first)).norm(), link.rest_length, 1e-14);
  }
}

TEST(CoarseCloth, KeepsPinsThatLieAmongFreeParticles) {
  SpringMaterials limp;
  limp.structural = SpringMaterial{};
  BodyShape shape = make_cloth({.resolution = {kSide, kSide}}, limp);
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  const Index pinned = 7 * kSide + 13;
  builder.pin(pinned);
  const SpringNetwork network = builder.build();
  const auto cloth = coarsen(network, component_of(network), kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_NE(std::ranges::find(cloth->particles, pinned), cloth->particles.end());
  EXPECT_EQ(cloth->component.pin_count(), 1);
}

// Pins share the load by which the energy weighs links: a cloth of which half is pinned was stretched by three times its tolerance.
TEST(CoarseCloth, HangsOnThePinsThatHoldItAlone) {
  SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  network.inverse_masses.tail(kSide / 2 * kSide).setZero();
  const StretchComponent fine = component_of(network);
  ASSERT_EQ(fine.pin_count(), kSide);
  const auto cloth = coarsen(network, fine, kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_EQ(cloth->component.pin_count(), kSide / 2);
  EXPECT_GT(cloth->pins.size(), kSide / 2);
}

TEST(CoarseCloth, IsMadeOfWholeClothsAlone) {
  EXPECT_FALSE(coarsen(make_test_rope(40, 0.0), component_of(make_test_rope(40, 0.0)), kLimit.kinds));
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  EXPECT_TRUE(coarsen(network, component_of(network), {SpringKind::structural, SpringKind::shear, SpringKind::bend}));
  EXPECT_FALSE(coarsen(network, component_of(network), {SpringKind::shear}));
  SpringNetwork parted = network;
  parted.bodies.front().resolution = {};
  EXPECT_FALSE(coarsen(parted, component_of(parted), kLimit.kinds));
  SpringNetwork halved = network;  // by a row of pins
  halved.inverse_masses.segment(kSide / 2 * kSide, kSide).setZero();
  EXPECT_FALSE(coarsen(halved, component_of(halved), kLimit.kinds));
}

SpringNetwork limp_cloth(const SpringMaterials& materials, const std::vector<std::array<Index, 2>>& seams = {}) {
  BodyShape shape = make_cloth({.resolution = {kSide, kSide}}, materials);
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  for (const auto& [i, j] : seams) builder.add_spring(i, j, 0.0, 0.01);
  return builder.build();
}

// What is sewn on holds too: a strap, a second spring between neighbours, and one from the end of a row to the next row's begin.
TEST(CoarseCloth, IsMadeOfClothsWithTheirOwnSpringsAlone) {
  SpringMaterials limp;
  limp.structural = SpringMaterial{};
  const SpringNetwork plain = limp_cloth(limp);
  ASSERT_TRUE(coarsen(plain, component_of(plain), kLimit.kinds));
  const std::vector<std::array<Index, 2>> seams{{0, kSide / 2}, {0, 1}, {kSide - 1, kSide}};
  for (const std::array<Index, 2>& seam : seams) {
    const SpringNetwork sewn = limp_cloth(limp, {seam});
    EXPECT_FALSE(coarsen(sewn, component_of(sewn), kLimit.kinds)) << seam[1];
  }
  SpringNetwork slit = plain;
  slit.springs.kind.front() = SpringKind::bend;
  EXPECT_FALSE(coarsen(slit, component_of(slit), kLimit.kinds));
}

// A limit of shear springs that there are none of lets a cloth shear.
TEST(CoarseCloth, IsJoinedAcrossCellsOnlyAsTheClothIs) {
  const std::vector<SpringKind> kinds{SpringKind::structural, SpringKind::shear};
  SpringMaterials limp;
  limp.structural = SpringMaterial{};
  const auto links = [&](const SpringNetwork& network) {
    return coarsen(network, component_of(network), kinds).value().component.links.size();
  };
  const std::size_t straight = links(limp_cloth(limp));
  limp.shear = SpringMaterial{};
  EXPECT_GT(links(limp_cloth(limp)), straight);
  EXPECT_EQ(straight, 2 * (kSide / 2) * (kSide / 2 - 1));
}

// It hangs within half of its tolerance, so that passes have nothing to do, at rest to the last bit, and as low as a cloth that is
// solved for as a whole: that gives by up to its tolerance, four times as much as coarse links do, and sags between its pins by at
// most the root of 3/8 of that, 6 %.
TEST(TwoLevelNewton, AClothThatHangsComesToRestWithinTheLimit) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  TwoLevelNewton both = two_levels(network);
  ComponentNewton whole(component_of(network), kLimit);
  Fall fall(network, both);
  Fall expected(network, whole);
  for (int step = 0; step < 300; ++step) {
    fall.step();
    expected.step();
  }
  const Points x = fall.x;
  EXPECT_EQ(fall.step(), 0);
  EXPECT_EQ(fall.x, x);
  EXPECT_NEAR(mean_height(x), mean_height(expected.x), 0.06);
  const StretchComponent component = component_of(network);
  for (const StretchComponent::Link& link : component.links) {
    const Vector3 between = x.col(component.points[link.first]) - x.col(component.points[link.second]);
    ASSERT_LT(between.norm(), (1.0 + 0.5 * kLimit.tolerance) * link.rest_length);
  }
}

// As the whole does, but for a tenth of the metre that it falls by in the end.
TEST(TwoLevelNewton, AClothThatSwingsDownFallsAsFast) {
  SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  for (Index i = 0; i < network.particle_count(); ++i) {
    network.positions.col(i) = Vector3(network.positions(0, i), 0.0, 0.5 - network.positions(1, i));
  }
  TwoLevelNewton both = two_levels(network);
  ComponentNewton whole(component_of(network), kLimit);
  Fall fall(network, both);
  Fall expected(network, whole);
  for (int step = 0; step < 30; ++step) {
    fall.step();
    expected.step();
    ASSERT_NEAR(mean_height(fall.x), mean_height(expected.x), 0.1) << step;
  }
  EXPECT_LT(mean_height(expected.x), -0.4);
}

// The coarse cloth does not know of what goes as far one way as its neighbours go the other.
TEST(TwoLevelNewton, WhatMovesBesideACoarseClothAtRestGoesOn) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  TwoLevelNewton both = two_levels(network);
  Fall fall(network, both);
  for (int step = 0; step < 300; ++step) fall.step();
  ASSERT_EQ(fall.step(), 0);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_pinned(i)) fall.v(2, i) = (i % 2 == 0 ? 1.0 : -1.0) * kGravity * kStep;
  }
  const Points x = fall.x;
  fall.step();
  EXPECT_GT((fall.x - x).colwise().norm().maxCoeff(), 0.1 * kFall);
}

TEST(TwoLevelNewton, KeepsTheMomentumOfWhatFlies) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0, false);
  TwoLevelNewton both = two_levels(network);
  Points led = network.positions;
  for (Index i = 0; i < network.particle_count(); ++i) led.col(i) *= 1.0 + 0.1 * network.positions(0, i);
  Points x = led;
  ASSERT_TRUE(both.solve(network.positions, x, kFall));
  const Vector3 moved = (x - led) * network.masses;
  EXPECT_LT(moved.norm(), 1e-12 * network.masses.sum());
  EXPECT_GT((x - led).norm(), 1e-3);
}

TEST(TwoLevelNewton, IsForLargeClothsThatMeetNothing) {
  const SpringNetwork large = make_test_cloth(96, 0.0, 0.0);
  const auto is_two = [&](const SpringNetwork& network, const StretchLimitSettings& settings, bool meets) {
    const auto solver = make_component_solver(network, component_of(network), settings, {.may_meet_anything = meets});
    return dynamic_cast<const TwoLevelNewton*>(solver.get()) != nullptr;
  };
  EXPECT_TRUE(is_two(large, kLimit, false));
  EXPECT_FALSE(is_two(large, kLimit, true));
  EXPECT_FALSE(is_two(large, {.max_stretch = 0.02, .tolerance = 0.001}, false));
  EXPECT_FALSE(is_two(make_test_cloth(kSide, 0.0, 0.0), kLimit, false));
  EXPECT_FALSE(is_two(make_test_cloth(96, 10.0, 0.0), kLimit, false));
}

}  // namespace
}  // namespace sprung
