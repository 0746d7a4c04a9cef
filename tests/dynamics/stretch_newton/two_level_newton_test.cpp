#include "dynamics/stretch_newton/two_level_newton.h"

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

/// Steps from rest of a network without stiffness.
class Fall {
 public:
  Fall(const SpringNetwork& network, ComponentSolver& solver) : x(network.positions), network_(network), solver_(solver) {}

  std::optional<int> step() {
    Points target = x;
    for (Index i = 0; i < network_.particle_count(); ++i) {
      if (!network_.is_fixed(i)) target.col(i) += kStep * v.col(i) - kFall * Vector3::UnitY();
    }
    const auto solves = solver_.solve(x, target, kFall);
    v = (target - x) / kStep;
    x = target;
    return solves;
  }

  Points x;
  Points v = Points::Zero(3, x.cols());

 private:
  const SpringNetwork& network_;
  ComponentSolver& solver_;
};

struct Seam {
  Index from;
  Index to;
  SpringKind kind;
};

/// A cloth of structural springs without stiffness, optionally with shear springs, and with further springs sewn on.
SpringNetwork limp_cloth(const std::vector<Index>& pins, const std::vector<Seam>& seams = {}, bool has_shear = false) {
  SpringMaterials limp;
  limp.structural = SpringMaterial{};
  if (has_shear) limp.shear = SpringMaterial{};
  BodyShape shape = make_cloth({.resolution = {kSide, kSide}}, limp);
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  if (!pins.empty()) builder.pin(pins);
  for (const Seam& seam : seams) builder.add_spring(seam.from, seam.to, 0.0, 0.01, 0.0, seam.kind);
  return builder.build();
}

double mean_height(const Points& x) { return x.row(1).mean(); }

/// The same cloth on two levels and on one.
struct BothSolvers {
  explicit BothSolvers(const SpringNetwork& network)
      : two(two_levels(network)), one(component_of(network), kLimit), fall(network, two), expected(network, one) {}

  void step() {
    fall.step();
    expected.step();
  }

  TwoLevelNewton two;
  ComponentNewton one;
  Fall fall;
  Fall expected;
};

TEST(CoarseCloth, HasAQuarterOfTheParticlesAndAllOfTheMass) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0, false);
  const StretchComponent fine = component_of(network);
  const auto cloth = coarsen(network, fine, kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_EQ(cloth->particles.size(), fine.points.size() / 4);
  const std::vector<double>& masses = cloth->component.masses;
  EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), network.masses.sum(), 1e-14 * network.masses.sum());
  // Along rows and columns only: without limited shear springs no links cross cells.
  EXPECT_EQ(cloth->component.links.size(), 2 * (kSide / 2) * (kSide / 2 - 1));
}

// A particle between corners of a flat cloth is their weighted mean, and a link is as long as the springs along it.
TEST(CoarseCloth, CoincidesWithTheFineCloth) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  const StretchComponent fine = component_of(network);
  const auto cloth = coarsen(network, fine, {SpringKind::structural, SpringKind::shear});
  ASSERT_TRUE(cloth);
  for (Index n = 0; n < fine.free_count; ++n) {
    Vector3 mean = Vector3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      mean += cloth->interpolations[n].weights[k] * network.positions.col(cloth->particles[cloth->interpolations[n].points[k]]);
    }
    EXPECT_NEAR((mean - network.positions.col(fine.points[n])).norm(), 0.0, 1e-14);
  }
  const auto at = [&](Index point) -> Vector3 { return network.positions.col(cloth->particles[cloth->component.points[point]]); };
  for (const StretchComponent::Link& link : cloth->component.links) {
    EXPECT_NEAR((at(link.second) - at(link.first)).norm(), link.rest_length, 1e-14);
  }
}

TEST(CoarseCloth, KeepsPinsThatLieAmongFreeParticles) {
  const Index pinned = 7 * kSide + 13;
  const SpringNetwork network = limp_cloth({pinned});
  const auto cloth = coarsen(network, component_of(network), kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_NE(std::ranges::find(cloth->particles, pinned), cloth->particles.end());
  EXPECT_EQ(cloth->component.pin_count(), 1);
}

TEST(CoarseCloth, IsNotMadeWherePinsWouldKeepMostParticles) {
  std::vector<Index> pins;
  for (Index i = 1; i < kSide; i += 2) pins.push_back(i * kSide + i);
  const SpringNetwork network = limp_cloth(pins);
  EXPECT_FALSE(coarsen(network, component_of(network), kLimit.kinds));
}

// Pins share the load that weighs links in the energy: with uninvolved pins, a half-pinned cloth was stretched by three times its
// tolerance.
TEST(CoarseCloth, LinksOnlyPinsWithFreeNeighbours) {
  SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  network.inverse_masses.tail(kSide / 2 * kSide).setZero();
  const StretchComponent fine = component_of(network);
  ASSERT_EQ(fine.pin_count(), kSide);
  const auto cloth = coarsen(network, fine, kLimit.kinds);
  ASSERT_TRUE(cloth);
  EXPECT_EQ(cloth->component.pin_count(), kSide / 2);
  EXPECT_GT(cloth->pins.size(), kSide / 2);
}

TEST(CoarseCloth, IsMadeOfWholeClothsOnly) {
  EXPECT_FALSE(coarsen(make_test_rope(40, 0.0), component_of(make_test_rope(40, 0.0)), kLimit.kinds));
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  EXPECT_TRUE(coarsen(network, component_of(network), {SpringKind::structural, SpringKind::shear, SpringKind::bend}));
  EXPECT_FALSE(coarsen(network, component_of(network), {SpringKind::shear}));
  SpringNetwork no_grid = network;
  no_grid.bodies.front().resolution = {};
  EXPECT_FALSE(coarsen(no_grid, component_of(no_grid), kLimit.kinds));
  SpringNetwork halved = network;  // divided by a row of pins
  halved.inverse_masses.segment(kSide / 2 * kSide, kSide).setZero();
  EXPECT_FALSE(coarsen(halved, component_of(halved), kLimit.kinds));
}

// Further springs are limited too: a strap, a second spring between neighbours, a spring from the end of a row to the beginning of
// the next, one across a single cell, and a bend spring across many.
TEST(CoarseCloth, IsMadeOfClothsWithTheirOwnSpringsOnly) {
  const std::vector<SpringKind> kinds{SpringKind::structural, SpringKind::shear, SpringKind::bend};
  const SpringNetwork plain = limp_cloth({});
  ASSERT_TRUE(coarsen(plain, component_of(plain), kinds));
  const std::vector<Seam> seams{{0, kSide / 2, SpringKind::structural},
                                {0, 1, SpringKind::structural},
                                {kSide - 1, kSide, SpringKind::structural},
                                {0, kSide + 1, SpringKind::shear},
                                {0, kSide / 2, SpringKind::bend}};
  for (const Seam& seam : seams) {
    const SpringNetwork sewn = limp_cloth({}, {seam});
    EXPECT_FALSE(coarsen(sewn, component_of(sewn), kinds)) << seam.from << " to " << seam.to;
  }
  SpringNetwork slit = plain;
  slit.springs.kind.front() = SpringKind::bend;
  EXPECT_FALSE(coarsen(slit, component_of(slit), kLimit.kinds));
}

// If shear springs are limited but the cloth has none, it may shear.
TEST(CoarseCloth, HasDiagonalLinksOnlyWhereTheClothHas) {
  const std::vector<SpringKind> kinds{SpringKind::structural, SpringKind::shear};
  const auto links = [&](const SpringNetwork& network) {
    return coarsen(network, component_of(network), kinds).value().component.links.size();
  };
  const std::size_t straight = 2 * (kSide / 2) * (kSide / 2 - 1);
  EXPECT_EQ(links(limp_cloth({})), straight);
  EXPECT_EQ(links(limp_cloth({}, {}, true)), straight + 2 * (kSide / 2 - 1) * (kSide / 2 - 1));
}

// The cloth hangs within half of its tolerance, so that passes have nothing to do, and rests to the last bit. It hangs as low as a
// cloth solved on one level: that one stretches by up to its tolerance, four times as much as coarse links, and sags between its
// pins by at most the root of 3/8 of that, 6 %.
TEST(TwoLevelNewton, AClothThatHangsComesToRestWithinTheLimit) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  BothSolvers both(network);
  for (int step = 0; step < 300; ++step) both.step();
  const Points x = both.fall.x;
  EXPECT_EQ(both.fall.step(), 0);
  EXPECT_EQ(both.fall.x, x);
  EXPECT_NEAR(mean_height(x), mean_height(both.expected.x), 0.06);
  const StretchComponent component = component_of(network);
  for (const StretchComponent::Link& link : component.links) {
    const Vector3 between = x.col(component.points[link.first]) - x.col(component.points[link.second]);
    ASSERT_LT(between.norm(), (1.0 + 0.5 * kLimit.tolerance) * link.rest_length);
  }
}

// It falls as on one level, up to a tenth of the metre of its whole fall.
TEST(TwoLevelNewton, AClothThatSwingsDownFallsAsFast) {
  SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  for (Index i = 0; i < network.particle_count(); ++i) {
    network.positions.col(i) = Vector3(network.positions(0, i), 0.0, 0.5 - network.positions(1, i));
  }
  BothSolvers both(network);
  for (int step = 0; step < 30; ++step) {
    both.step();
    ASSERT_NEAR(mean_height(both.fall.x), mean_height(both.expected.x), 0.1) << step;
  }
  EXPECT_LT(mean_height(both.expected.x), -0.4);
}

/// Sets velocities across the cloth: of particles that are no coarse points as large as gravity gives in a step, of coarse points
/// such that all means are 0.
void move_beside(const CoarseCloth& cloth, const SpringNetwork& network, Points& v) {
  const StretchComponent fine = component_of(network);
  v.row(2).setZero();
  for (Index n = 0; n < fine.free_count; ++n) {
    const Index i = fine.points[n];
    if (std::ranges::find(cloth.particles, i) != cloth.particles.end()) continue;
    v(2, i) = kGravity * kStep;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index q = cloth.particles[cloth.interpolations[n].points[k]];
      if (!network.is_fixed(q)) v(2, q) -= cloth.interpolations[n].weights[k] * network.masses[i] / network.masses[q] * v(2, i);
    }
  }
}

// The coarse cloth does not contain this motion.
TEST(TwoLevelNewton, FineMotionContinuesWhileTheCoarseClothRests) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0);
  TwoLevelNewton both = two_levels(network);
  Fall fall(network, both);
  for (int step = 0; step < 300; ++step) fall.step();
  ASSERT_EQ(fall.step(), 0);
  move_beside(*coarsen(network, component_of(network), kLimit.kinds), network, fall.v);
  const Points x = fall.x;
  EXPECT_EQ(fall.step(), 0);
  EXPECT_GT((fall.x - x).colwise().norm().maxCoeff(), 0.1 * kFall);
}

TEST(TwoLevelNewton, ConservesTheMomentumOfAFreeNetwork) {
  const SpringNetwork network = make_test_cloth(kSide, 0.0, 0.0, false);
  TwoLevelNewton both = two_levels(network);
  Points target = network.positions;
  for (Index i = 0; i < network.particle_count(); ++i) target.col(i) *= 1.0 + 0.1 * network.positions(0, i);
  Points x = target;
  ASSERT_TRUE(both.solve(network.positions, x, kFall));
  const Vector3 moved = (x - target) * network.masses;
  EXPECT_LT(moved.norm(), 1e-12 * network.masses.sum());
  EXPECT_GT((x - target).norm(), 1e-3);
}

TEST(TwoLevelNewton, IsChosenForLargeClothsWithoutCollisions) {
  const SpringNetwork large = make_test_cloth(96, 0.0, 0.0);
  const auto is_two = [&](const SpringNetwork& network, const StretchLimitSettings& settings, bool may_collide) {
    const auto solver = make_component_solver(network, component_of(network), settings, {.may_collide = may_collide});
    return dynamic_cast<const TwoLevelNewton*>(solver.get()) != nullptr;
  };
  EXPECT_TRUE(is_two(large, kLimit, false));
  EXPECT_FALSE(is_two(large, kLimit, true));
  EXPECT_FALSE(is_two(make_test_cloth(kSide, 0.0, 0.0), kLimit, false));
  EXPECT_FALSE(is_two(make_test_cloth(96, 10.0, 0.0), kLimit, false));
}

}  // namespace
}  // namespace sprung
