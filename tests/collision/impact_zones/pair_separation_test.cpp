// The promise of self-contact: what does not cross at a step's begin does not at its end, whatever the targets are.
#include "base/parallel.h"
#include "base/test_seed.h"
#include "collision/self_networks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.01;
constexpr double kThickness = 0.003;
constexpr double kMargin = 0.001;
const Vector3 kX = Vector3::UnitX();
const Vector3 kY = Vector3::UnitY();
const Vector3 kZ = Vector3::UnitZ();

SelfNetwork cloth_of(Index side, double edge = kEdge) {
  SelfNetwork network;
  network.add_cloth(side, Vector3::Zero(), edge * kX, edge * kZ);
  return network;
}

/// A particle above the inside of a face of a sheet, the last.
SelfNetwork sheet_and_particle() {
  SelfNetwork network = cloth_of(4);
  network.add_single_particle({0.0123, 0.02, 0.0171});
  return network;
}

/// Every particle is thrown about by up to `speed` [m per step], and drawn to the middle.
std::function<Points(int, const Points&)> crumpling(double speed, std::uint64_t seed) {
  return [speed, random = test::Random(seed)](int, const Points& x) mutable {
    Points targets = x;
    const Vector3 middle = x.rowwise().mean();
    for (Index i = 0; i < static_cast<Index>(x.cols()); ++i) {
      targets.col(i) += random.between(0.0, speed) * random.direction() + 0.02 * (middle - x.col(i));
    }
    return targets;
  };
}

TEST(PairSeparation, ACrumplingClothNeverCrossesItself) {
  const SelfNetwork network = cloth_of(10);
  const CollisionSurface surface = network.surface(kThickness);
  for (const double speed : {0.1, 0.5, 2.0, 10.0}) {
    PairSeparation regions(surface, network.positions, kMargin);
    test::run(network, regions, 40, crumpling(speed * kEdge, 7),
              [&](const Points& x) { ASSERT_EQ(test::count_crossings(network.elements, x), 0) << "speed " << speed; });
  }
}

TEST(PairSeparation, ACrumplingPileOfEverythingNeverCrosses) {
  SelfNetwork network;
  network.add_cloth(6, {0.0, 0.0, 0.0}, kEdge * kX, kEdge * kZ);
  network.add_cloth(5, {0.0, 0.004, 0.001}, kEdge * kX, kEdge * kZ);
  network.add_rope(12, {-0.03, 0.008, 0.02}, kEdge * kX);
  network.add_rope(12, {0.03, 0.012, -0.03}, kEdge * kZ);
  for (int k = 0; k < 20; ++k) network.add_single_particle({0.003 * k, 0.016, 0.002 * k});
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  test::run(network, regions, 60, crumpling(0.5 * kEdge, 3),
            [&](const Points& x) { ASSERT_EQ(test::count_crossings(network.elements, x), 0); });
}

/// How many triangles of the first body are above a particle.
int sheets_above(const SelfNetwork& network, const Points& x, Index particle) {
  int count = 0;
  for (const Element& face : network.elements) {
    if (face.body != 0) continue;
    const auto& t = face.particles;
    const Vector3 far = x.col(particle) + 100.0 * kY;
    if (test::segment_meets_triangle(x.col(particle), far, x.col(t[0]), x.col(t[1]), x.col(t[2]))) ++count;
  }
  return count;
}

/// Sheets are offset so that corners meet faces and edges meet edges. The step is 1/60 s.
TEST(PairSeparation, SheetsThrownAtEachOtherStayOnTheirSides) {
  SelfNetwork network;
  network.add_cloth(12, {0.0, 0.1, 0.0}, kEdge * kX, kEdge * kZ);
  network.add_cloth(12, {0.003, -0.1, 0.002}, kEdge * Vector3(0.99, 0.0, 0.1), kEdge * Vector3(-0.1, 0.0, 0.99));
  const CollisionSurface surface = network.surface(kThickness);
  for (const double speed : {1.0, 50.0, 500.0}) {
    PairSeparation regions(surface, network.positions, kMargin);
    const auto half = network.count() / 2;
    const auto fly = [&](int, const Points& x) {
      Points targets = x;
      targets.row(1).head(half).array() -= 0.5 * speed / 60.0;
      targets.row(1).tail(half).array() += 0.5 * speed / 60.0;
      return targets;
    };
    const Points x = test::run(network, regions, 20, fly,
                               [&](const Points& now) { ASSERT_EQ(test::count_crossings(network.elements, now), 0) << speed; });
    // Seen from above, the middle of the lower sheet lies under the upper one; what is beside it may fly on.
    for (Index j = 4; j <= 8; ++j) {
      for (Index i = 4; i <= 8; ++i) EXPECT_EQ(sheets_above(network, x, half + 13 * j + i) % 2, 1) << speed << ' ' << i << ' ' << j;
    }
    if (speed == 1.0) {
      EXPECT_LT(x(1, 6 * 13 + 6) - x(1, half + 6 * 13 + 6), kThickness) << "they meet";
    }
  }
}

TEST(PairSeparation, RopesThrownAtEachOtherDoNotPass) {
  SelfNetwork network;
  network.add_rope(10, {-0.051, 0.05, 0.0}, kEdge * kX);
  network.add_rope(10, {0.0, -0.05, -0.047}, kEdge * kZ);
  const CollisionSurface surface = network.surface(kThickness);
  for (const double speed : {1.0, 50.0, 500.0}) {
    PairSeparation regions(surface, network.positions, kMargin);
    const auto fly = [&](int, const Points& x) {
      Points targets = x;
      targets.row(1).head(11).array() -= 0.5 * speed / 60.0;
      targets.row(1).tail(11).array() += 0.5 * speed / 60.0;
      return targets;
    };
    const Points x = test::run(network, regions, 20, fly);
    // Where they cross, seen from above: the sixth segment of each.
    EXPECT_GT(side_of_plane(x.col(5), x.col(6), x.col(16), x.col(15)), 0.0) << speed;
  }
}

TEST(PairSeparation, AParticleThrownAtASheetStaysOnItsSide) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  const auto fall = [&](int, const Points& x) {
    Points targets = x;
    targets.col(last) -= 8.0 * kY;
    return targets;
  };
  const Points x = test::run(network, regions, 3, fall);
  EXPECT_GT(x(1, last), x.row(1).head(last).maxCoeff());
  EXPECT_LT((x - network.positions).leftCols(last).colwise().norm().maxCoeff(), kThickness) << "the sheet is not carried away";
}

// An eighth of it, where both had more: what goes on from there has room to turn.
TEST(PairSeparation, AParticleThrownAtASheetKeepsAPartOfTheThickness) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  for (const double fall : {0.021, 0.05}) {
    Points ends = network.positions;
    ends(1, last) -= fall;
    std::vector<Contact> contacts;
    regions.begin_step(network.positions, ends, contacts);
    const std::vector<Index> held = regions.hold(network.positions, ends);
    EXPECT_THAT(held, testing::Contains(last)) << fall;
    for (const Index i : held) ends.col(i) = regions.safe_place(i);
    EXPECT_NEAR(ends(1, last) - ends.row(1).head(last).maxCoeff(), kThickness / 8.0, 1e-12 * fall) << fall;
  }
}

// Pairs are listed for as far as the ball reaches: beyond it there may be anything.
TEST(PairSeparation, NoPlaceOutsideAParticlesBallIsAllowed) {
  const SelfNetwork network = cloth_of(2);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  regions.begin_step(network.positions, network.positions, contacts);
  EXPECT_THAT(regions.hold(network.positions, network.positions), testing::IsEmpty());
  const PairSeparation::Ball ball = regions.ball(0);
  EXPECT_TRUE(regions.allows(0, ball.center - 0.99 * ball.radius * kY));
  EXPECT_FALSE(regions.allows(0, ball.center - 1.01 * ball.radius * kY));
}

/// Each step takes it half of the way to the sheet, but never below what rounding, 2^-53 of the coordinates, cannot take away.
TEST(PairSeparation, AParticleThatComesNearerEachStepKeepsClear) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation regions(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  const auto approach = [&](int, const Points& x) {
    Points targets = network.positions;
    targets.col(last) = Vector3(0.0123, 0.5 * x(1, last), 0.0171);
    return targets;
  };
  const Points x = test::run(network, regions, 80, approach);
  EXPECT_GT(x(1, last) - x.row(1).head(last).maxCoeff(), 0x1p-34 * x.cwiseAbs().maxCoeff());
}

TEST(PairSeparation, BodiesThatDoNotCollidePass) {
  SelfNetwork network;
  network.add_cloth(6, {0.0, 0.02, 0.0}, kEdge * kX, kEdge * kZ);
  network.add_cloth(6, {0.0, -0.02, 0.0}, kEdge * kX, kEdge * kZ);
  CollisionSurface surface = network.surface(kThickness);
  surface.others[1] = 0;
  PairSeparation regions(surface, network.positions, kMargin);
  const auto half = network.count() / 2;
  Points targets = network.positions;
  targets.row(1).head(half).array() -= 0.1;
  std::vector<Contact> contacts;
  regions.begin_step(network.positions, targets, contacts);
  EXPECT_THAT(regions.hold(network.positions, targets), testing::IsEmpty());
  EXPECT_THAT(contacts, testing::IsEmpty());
}

TEST(PairSeparation, AFallingClothIsNotHeldBackAndHardlyLookedAt) {
  const SelfNetwork network = cloth_of(20);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  Points x = network.positions;
  std::vector<Contact> contacts;
  Index renewed = 0;
  const double dt = 1.0 / 1200.0;
  for (int step = 0; step < 100; ++step) {
    Points targets = x;
    targets.row(1).array() -= 10.0 * dt + 9.81 * dt * dt * (step + 0.5);
    regions.begin_step(x, targets, contacts);
    ASSERT_THAT(regions.hold(x, targets), testing::IsEmpty());
    if (step > 0) renewed += regions.counts().renewed;
    x = targets;
  }
  EXPECT_THAT(contacts, testing::IsEmpty());
  // Gravity alone takes a particle out of its ball, a tenth of an edge, in sqrt(0.2 edge / g) = 14 ms, 17 steps.
  EXPECT_LE(renewed, 6 * network.count());
}

/// What falls as a whole is looked for once in 64 steps. When it strikes something in between, that would be for 54 steps of the
/// way that it no longer goes: 190 times as many pairs as for those that it is looked for in when it begins to move so.
TEST(PairSeparation, AClothThatStopsFallingIsNotLookedForWhereItWouldHaveFallen) {
  const SelfNetwork network = cloth_of(20);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  const auto falling = [](int, const Points& x) {
    Points targets = x;
    targets.row(1).array() -= 0.5 * kEdge;
    return targets;
  };
  Points x = test::run(network, regions, 10, falling);
  const auto strike = crumpling(0.5 * kEdge, 7);
  for (int step = 0; step < 5; ++step) {
    PairSeparation anew(surface, network.positions, kMargin);
    const Points targets = strike(step, x);
    std::vector<Contact> contacts;
    anew.begin_step(x, targets, contacts);
    regions.begin_step(x, targets, contacts);
    EXPECT_LE(regions.counts().pairs, 2 * anew.counts().pairs + network.count()) << step;
    EXPECT_LE(regions.counts().candidates, 2 * anew.counts().candidates + network.count()) << step;
    Points ends = targets;
    test::truncate(regions, x, ends);
    x = ends;
  }
}

/// What is crumpled already flies on as it is: nothing in it is in the way of anything else.
TEST(PairSeparation, ACrumpledClothIsNotHeldBackByItsFlight) {
  SelfNetwork network = cloth_of(10);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  Points x = test::run(network, regions, 40, crumpling(kEdge, 7));
  std::vector<Contact> contacts;
  for (int step = 0; step < 5; ++step) {
    Points targets = x;
    targets.colwise() += Vector3(2.0, -1.0, 0.5);
    regions.begin_step(x, targets, contacts);
    EXPECT_THAT(regions.hold(x, targets), testing::IsEmpty());
    x = targets;
  }
}

TEST(PairSeparation, PinnedParticlesReachTheirTargets) {
  SelfNetwork network = cloth_of(6);
  network.pinned[0] = 1;
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation regions(surface, network.positions, kMargin);
  const auto fold = [&](int step, const Points& x) {
    Points targets = x;
    targets.col(0) = network.positions.col(0) + 0.004 * step * Vector3(1.0, step < 10 ? 0.5 : -0.5, 1.0);
    return targets;
  };
  Points x = network.positions;
  std::vector<Contact> contacts;
  for (int step = 0; step < 20; ++step) {
    const Points wanted = fold(step, x);
    Points targets = wanted;
    regions.begin_step(x, targets, contacts);
    test::truncate(regions, x, targets);
    EXPECT_EQ(targets.col(0), wanted.col(0));
    x = targets;
  }
}

/// Pins two corners of the cloth and its middle.
void pin_three(SelfNetwork& network) {
  for (const Index i : {Index{0}, network.count() / 2, network.count() - 1}) network.pinned[static_cast<std::size_t>(i)] = 1;
}

/// Takes each pin from its place to `way(place)` in each step, whatever becomes of the others.
template <class PlaceAfter>
std::function<Points(int, const Points&)> led(const std::function<Points(int, const Points&)>& others, const SelfNetwork& network,
                                              const PlaceAfter& way) {
  return [&network, others, way](int step, const Points& x) {
    Points targets = others(step, x);
    for (Index i = 0; i < network.count(); ++i) {
      if (network.pinned[static_cast<std::size_t>(i)] != 0) targets.col(i) = way(Vector3(x.col(i)));
    }
    return targets;
  };
}

// What is in the way of a pin, or hangs on one, goes its way.
TEST(PairSeparation, ACrumplingClothNeverCrossesItselfAtPinsThatRestOrMoveRigidly) {
  SelfNetwork network = cloth_of(6);
  pin_three(network);
  const CollisionSurface surface = network.surface(kThickness);
  RigidTransform shift = RigidTransform::Identity();
  shift.translation() = kEdge * Vector3(0.3, -0.2, 0.1);
  RigidTransform turn = shift;
  turn.linear() = Eigen::AngleAxisd(0.3, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  for (const RigidTransform& motion : {RigidTransform(RigidTransform::Identity()), shift, turn}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      PairSeparation regions(surface, network.positions, kMargin);
      const auto moved = [&](const Vector3& pin) -> Vector3 { return motion * pin; };
      test::run(network, regions, 60, led(crumpling(2.0 * kEdge, test::seeded(seed)), network, moved), [&](const Points& x) {
        ASSERT_EQ(test::count_crossings(network.elements, x), 0) << "seed " << seed << ", " << motion.matrix();
      });
    }
  }
}

TEST(PairSeparation, WhatPinsDragThroughEachOtherIsTold) {
  SelfNetwork network = cloth_of(6);
  pin_three(network);
  const CollisionSurface surface = network.surface(kThickness);
  int crossed = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(test::seeded(seed));
    PairSeparation regions(surface, network.positions, kMargin);
    const auto apart = [&](const Vector3& pin) -> Vector3 { return pin + 3.0 * kEdge * random.direction(); };
    const auto move = led(crumpling(kEdge, test::seeded(seed)), network, apart);
    Points x = network.positions;
    std::vector<Contact> contacts;
    for (int step = 0; step < 40 && test::count_crossings(network.elements, x) == 0; ++step) {
      Points targets = move(step, x);
      regions.begin_step(x, targets, contacts);
      test::truncate(regions, x, targets);
      x = targets;
      if (test::count_crossings(network.elements, x) == 0) continue;
      ++crossed;
      Index told = 0;
      for (Index i = 0; i < network.count(); ++i) {
        told += network.pinned[static_cast<std::size_t>(i)] == 0 && regions.passes(i) ? 1 : 0;
      }
      EXPECT_GT(told, 0) << "seed " << seed << ", step " << step;
    }
  }
  EXPECT_GT(crossed, 0);
}

/// Two squares over each other; of the lower one a corner is free.
SelfNetwork two_pinned_squares() {
  SelfNetwork network;
  network.add_cloth(1, {0.0, 0.0, 0.0}, Vector3::UnitX(), Vector3::UnitZ());
  network.add_cloth(1, {0.2, 1e-3, 0.2}, Vector3::UnitX(), Vector3::UnitZ());
  network.pinned.assign(network.pinned.size(), 1);
  network.pinned[1] = 0;
  return network;
}

// About an axis that leans to their plane: no plane whose normal turns at even speed keeps them apart.
TEST(PairSeparation, PinsThatTurnTogetherAreNotToldToPass) {
  const SelfNetwork network = two_pinned_squares();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation regions(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  const Points targets = Eigen::AngleAxisd(1.0, Vector3(1.0, 1.0, 1.0).normalized()).toRotationMatrix() * network.positions;
  regions.begin_step(network.positions, targets, contacts);
  regions.hold(network.positions, targets);
  EXPECT_TRUE(regions.passing_pins().empty());
}

TEST(PairSeparation, PinsThatGoThroughEachOtherAreTold) {
  const SelfNetwork network = two_pinned_squares();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation regions(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  Points targets = network.positions;
  targets.row(1).tail(4).array() -= 0.2;
  regions.begin_step(network.positions, targets, contacts);
  regions.hold(network.positions, targets);
  EXPECT_FALSE(regions.passing_pins().empty());
}

TEST(PairSeparation, ScaledScenesGiveTheSameBits) {
  std::vector<Points> ends;
  for (const double scale : {1.0, 0x1p7, 0x1p-7}) {
    SelfNetwork network = cloth_of(8);
    network.positions *= scale;
    const CollisionSurface surface = network.surface(scale * kThickness);
    PairSeparation regions(surface, network.positions, scale * kMargin);
    ends.emplace_back(test::run(network, regions, 20, crumpling(scale * kEdge, 5)) / scale);
  }
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(ends[0], ends[2]);
}

TEST(PairSeparation, AnyNumberOfThreadsGivesTheSameBits) {
  const SelfNetwork network = cloth_of(24);
  const CollisionSurface surface = network.surface(kThickness);
  std::vector<Points> ends;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    PairSeparation regions(surface, network.positions, kMargin);
    ends.push_back(test::run(network, regions, 10, crumpling(kEdge, 5)));
  }
  EXPECT_EQ(ends[0], ends[1]);
}

}  // namespace
}  // namespace sprung
