// The promise of self-contact: elements that do not cross at a step's begin do not cross at its end, whatever the targets are.
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

/// A sheet, and as its last particle one above the inside of a face.
SelfNetwork sheet_and_particle() {
  SelfNetwork network = cloth_of(4);
  network.add_single_particle({0.0123, 0.02, 0.0171});
  return network;
}

/// Moves every particle by up to `speed` [m per step] in a random direction and a little towards the centroid.
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
    PairSeparation separation(surface, network.positions, kMargin);
    test::run(network, separation, 40, crumpling(speed * kEdge, 7),
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
  PairSeparation separation(surface, network.positions, kMargin);
  test::run(network, separation, 60, crumpling(0.5 * kEdge, 3),
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

/// Sheets are offset so that vertices hit faces and edges hit edges. The step is 1/60 s.
TEST(PairSeparation, SheetsThrownAtEachOtherStayOnTheirSides) {
  SelfNetwork network;
  network.add_cloth(12, {0.0, 0.1, 0.0}, kEdge * kX, kEdge * kZ);
  network.add_cloth(12, {0.003, -0.1, 0.002}, kEdge * Vector3(0.99, 0.0, 0.1), kEdge * Vector3(-0.1, 0.0, 0.99));
  const CollisionSurface surface = network.surface(kThickness);
  for (const double speed : {1.0, 50.0, 500.0}) {
    PairSeparation separation(surface, network.positions, kMargin);
    const auto half = network.count() / 2;
    const auto fly = [&](int, const Points& x) {
      Points targets = x;
      targets.row(1).head(half).array() -= 0.5 * speed / 60.0;
      targets.row(1).tail(half).array() += 0.5 * speed / 60.0;
      return targets;
    };
    const Points x = test::run(network, separation, 20, fly,
                               [&](const Points& now) { ASSERT_EQ(test::count_crossings(network.elements, now), 0) << speed; });
    // Seen from above, the middle of the lower sheet is under the upper one. Its border may fly past.
    for (Index j = 4; j <= 8; ++j) {
      for (Index i = 4; i <= 8; ++i) EXPECT_EQ(sheets_above(network, x, half + 13 * j + i) % 2, 1) << speed << ' ' << i << ' ' << j;
    }
    if (speed == 1.0) {
      EXPECT_LT(x(1, 6 * 13 + 6) - x(1, half + 6 * 13 + 6), kThickness) << "they touch";
    }
  }
}

TEST(PairSeparation, RopesThrownAtEachOtherDoNotPass) {
  SelfNetwork network;
  network.add_rope(10, {-0.051, 0.05, 0.0}, kEdge * kX);
  network.add_rope(10, {0.0, -0.05, -0.047}, kEdge * kZ);
  const CollisionSurface surface = network.surface(kThickness);
  for (const double speed : {1.0, 50.0, 500.0}) {
    PairSeparation separation(surface, network.positions, kMargin);
    const auto fly = [&](int, const Points& x) {
      Points targets = x;
      targets.row(1).head(11).array() -= 0.5 * speed / 60.0;
      targets.row(1).tail(11).array() += 0.5 * speed / 60.0;
      return targets;
    };
    const Points x = test::run(network, separation, 20, fly);
    // Seen from above, they cross at the sixth segment of each.
    EXPECT_GT(side_of_plane(x.col(5), x.col(6), x.col(16), x.col(15)), 0.0) << speed;
  }
}

TEST(PairSeparation, AParticleThrownAtASheetStaysOnItsSide) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  const auto fall = [&](int, const Points& x) {
    Points targets = x;
    targets.col(last) -= 8.0 * kY;
    return targets;
  };
  const Points x = test::run(network, separation, 3, fall);
  EXPECT_GT(x(1, last), x.row(1).head(last).maxCoeff());
  EXPECT_LT((x - network.positions).leftCols(last).colwise().norm().maxCoeff(), kThickness) << "the sheet stays";
}

// An eighth of the thickness, if the gap was larger before. The rest is room to rotate.
TEST(PairSeparation, AParticleThrownAtASheetKeepsAFractionOfTheThickness) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  for (const double fall : {0.021, 0.05}) {
    Points ends = network.positions;
    ends(1, last) -= fall;
    std::vector<Contact> contacts;
    separation.begin_step(network.positions, ends, contacts);
    const std::vector<Index> constrained = separation.constrain(network.positions, ends);
    EXPECT_THAT(constrained, testing::Contains(last)) << fall;
    for (const Index i : constrained) ends.col(i) = separation.safe_position(i);
    EXPECT_NEAR(ends(1, last) - ends.row(1).head(last).maxCoeff(), kThickness / 8.0, 1e-12 * fall) << fall;
  }
}

// The list is complete only as far as the sphere reaches.
TEST(PairSeparation, NoPositionOutsideAParticlesSphereIsAllowed) {
  const SelfNetwork network = cloth_of(2);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  separation.begin_step(network.positions, network.positions, contacts);
  EXPECT_THAT(separation.constrain(network.positions, network.positions), testing::IsEmpty());
  const PairSeparation::Sphere sphere = separation.sphere(0);
  EXPECT_TRUE(separation.allows(0, sphere.center - 0.99 * sphere.radius * kY));
  EXPECT_FALSE(separation.allows(0, sphere.center - 1.01 * sphere.radius * kY));
}

/// Each step halves the distance to the sheet, which has to stay well above the rounding of coordinates, 2^-53.
TEST(PairSeparation, AParticleThatApproachesInEachStepKeepsAClearance) {
  const SelfNetwork network = sheet_and_particle();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation separation(surface, network.positions, kMargin);
  const Index last = network.count() - 1;
  const auto approach = [&](int, const Points& x) {
    Points targets = network.positions;
    targets.col(last) = Vector3(0.0123, 0.5 * x(1, last), 0.0171);
    return targets;
  };
  const Points x = test::run(network, separation, 80, approach);
  EXPECT_GT(x(1, last) - x.row(1).head(last).maxCoeff(), 0x1p-34 * x.cwiseAbs().maxCoeff());
}

TEST(PairSeparation, BodiesThatDoNotCollidePass) {
  SelfNetwork network;
  network.add_cloth(6, {0.0, 0.02, 0.0}, kEdge * kX, kEdge * kZ);
  network.add_cloth(6, {0.0, -0.02, 0.0}, kEdge * kX, kEdge * kZ);
  CollisionSurface surface = network.surface(kThickness);
  surface.others[1] = 0;
  PairSeparation separation(surface, network.positions, kMargin);
  const auto half = network.count() / 2;
  Points targets = network.positions;
  targets.row(1).head(half).array() -= 0.1;
  std::vector<Contact> contacts;
  separation.begin_step(network.positions, targets, contacts);
  EXPECT_THAT(separation.constrain(network.positions, targets), testing::IsEmpty());
  EXPECT_THAT(contacts, testing::IsEmpty());
}

TEST(PairSeparation, AFallingClothIsNotConstrained) {
  const SelfNetwork network = cloth_of(20);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
  Points x = network.positions;
  std::vector<Contact> contacts;
  const double dt = 1.0 / 1200.0;
  for (int step = 0; step < 100; ++step) {
    Points targets = x;
    targets.row(1).array() -= 10.0 * dt + 9.81 * dt * dt * (step + 0.5);
    separation.begin_step(x, targets, contacts);
    ASSERT_THAT(separation.constrain(x, targets), testing::IsEmpty());
    x = targets;
  }
  EXPECT_THAT(contacts, testing::IsEmpty());
}

/// A translation of the whole cloth brings no two of its elements closer to each other.
TEST(PairSeparation, ACrumpledClothInFlightIsNotConstrained) {
  SelfNetwork network = cloth_of(10);
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
  Points x = test::run(network, separation, 40, crumpling(kEdge, 7));
  std::vector<Contact> contacts;
  for (int step = 0; step < 5; ++step) {
    Points targets = x;
    targets.colwise() += Vector3(2.0, -1.0, 0.5);
    separation.begin_step(x, targets, contacts);
    EXPECT_THAT(separation.constrain(x, targets), testing::IsEmpty());
    x = targets;
  }
}

TEST(PairSeparation, PinnedParticlesReachTheirTargets) {
  SelfNetwork network = cloth_of(6);
  network.motions[0] = ParticleMotion::driven;
  const CollisionSurface surface = network.surface(kThickness);
  PairSeparation separation(surface, network.positions, kMargin);
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
    separation.begin_step(x, targets, contacts);
    test::truncate(separation, x, targets);
    EXPECT_EQ(targets.col(0), wanted.col(0));
    x = targets;
  }
}

/// Pins two corners of the cloth and its middle.
void pin_three(SelfNetwork& network) {
  for (const Index i : {Index{0}, network.count() / 2, network.count() - 1})
    network.motions[static_cast<std::size_t>(i)] = ParticleMotion::driven;
}

/// Moves each pin from its position p to `motion(p)` in each step, and the other particles by `others`.
template <class Motion>
std::function<Points(int, const Points&)> with_pins_moved(const std::function<Points(int, const Points&)>& others,
                                                          const SelfNetwork& network, const Motion& motion) {
  return [&network, others, motion](int step, const Points& x) {
    Points targets = others(step, x);
    for (Index i = 0; i < network.count(); ++i) {
      if (is_fixed(network.motions, i)) targets.col(i) = motion(Vector3(x.col(i)));
    }
    return targets;
  };
}

// Particles that obstruct a pin, or hang on one, follow its motion.
TEST(PairSeparation, ACrumplingClothNeverCrossesItselfAtPinsThatRestOrMoveRigidly) {
  SelfNetwork network = cloth_of(6);
  pin_three(network);
  const CollisionSurface surface = network.surface(kThickness);
  RigidTransform shift = RigidTransform::Identity();
  shift.translation() = kEdge * Vector3(0.3, -0.2, 0.1);
  RigidTransform rotation = shift;
  rotation.linear() = Eigen::AngleAxisd(0.3, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  for (const RigidTransform& motion : {RigidTransform(RigidTransform::Identity()), shift, rotation}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      PairSeparation separation(surface, network.positions, kMargin);
      const auto moved = [&](const Vector3& pin) -> Vector3 { return motion * pin; };
      test::run(network, separation, 60, with_pins_moved(crumpling(2.0 * kEdge, test::seeded(seed)), network, moved),
                [&](const Points& x) {
                  ASSERT_EQ(test::count_crossings(network.elements, x), 0) << "seed " << seed << ", " << motion.matrix();
                });
    }
  }
}

TEST(PairSeparation, ParticlesThatPinsDragThroughEachOtherAreReported) {
  SelfNetwork network = cloth_of(6);
  pin_three(network);
  const CollisionSurface surface = network.surface(kThickness);
  int crossed = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(test::seeded(seed));
    PairSeparation separation(surface, network.positions, kMargin);
    const auto apart = [&](const Vector3& pin) -> Vector3 { return pin + 3.0 * kEdge * random.direction(); };
    const auto move = with_pins_moved(crumpling(kEdge, test::seeded(seed)), network, apart);
    Points x = network.positions;
    std::vector<Contact> contacts;
    for (int step = 0; step < 40 && test::count_crossings(network.elements, x) == 0; ++step) {
      Points targets = move(step, x);
      separation.begin_step(x, targets, contacts);
      test::truncate(separation, x, targets);
      x = targets;
      if (test::count_crossings(network.elements, x) == 0) continue;
      ++crossed;
      Index reported = 0;
      for (Index i = 0; i < network.count(); ++i) {
        reported += !is_fixed(network.motions, i) && separation.crosses(i) ? 1 : 0;
      }
      EXPECT_GT(reported, 0) << "seed " << seed << ", step " << step;
    }
  }
  EXPECT_GT(crossed, 0);
}

/// Two pinned squares above each other; one corner of the lower one is free.
SelfNetwork two_pinned_squares() {
  SelfNetwork network;
  network.add_cloth(1, {0.0, 0.0, 0.0}, Vector3::UnitX(), Vector3::UnitZ());
  network.add_cloth(1, {0.2, 1e-3, 0.2}, Vector3::UnitX(), Vector3::UnitZ());
  network.motions.assign(network.motions.size(), ParticleMotion::driven);
  network.motions[1] = ParticleMotion::free;
  return network;
}

// The axis is oblique to the squares: no plane whose normal changes linearly separates them.
TEST(PairSeparation, PinsThatRotateTogetherAreNotReported) {
  const SelfNetwork network = two_pinned_squares();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation separation(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  const Points targets = Eigen::AngleAxisd(1.0, Vector3(1.0, 1.0, 1.0).normalized()).toRotationMatrix() * network.positions;
  separation.begin_step(network.positions, targets, contacts);
  separation.constrain(network.positions, targets);
  EXPECT_TRUE(separation.crossing_fixed().empty());
}

TEST(PairSeparation, PinsThatPassThroughEachOtherAreReported) {
  const SelfNetwork network = two_pinned_squares();
  const CollisionSurface surface = network.surface(0.0);
  PairSeparation separation(surface, network.positions, kMargin);
  std::vector<Contact> contacts;
  Points targets = network.positions;
  targets.row(1).tail(4).array() -= 0.2;
  separation.begin_step(network.positions, targets, contacts);
  separation.constrain(network.positions, targets);
  EXPECT_FALSE(separation.crossing_fixed().empty());
}

TEST(PairSeparation, ElementsAtRestThatPinsPassThroughAreReported) {
  SelfNetwork network = two_pinned_squares();
  Points targets = network.positions;
  targets.row(1).tail(4).array() -= 0.2;
  const auto reported = [&](ParticleMotion lower) {
    std::fill_n(network.motions.begin(), 4, lower);
    const CollisionSurface surface = network.surface(0.0);
    PairSeparation separation(surface, network.positions, kMargin);
    std::vector<Contact> contacts;
    separation.begin_step(network.positions, targets, contacts);
    separation.constrain(network.positions, targets);
    return separation.crossing_fixed();
  };
  EXPECT_FALSE(reported(ParticleMotion::at_rest).empty());
  EXPECT_TRUE(reported(ParticleMotion::driven).empty()) << "pins drive both as a whole";
}

TEST(PairSeparation, ScaledScenesGiveTheSameBits) {
  std::vector<Points> ends;
  for (const double scale : {1.0, 0x1p7, 0x1p-7}) {
    SelfNetwork network = cloth_of(8);
    network.positions *= scale;
    const CollisionSurface surface = network.surface(scale * kThickness);
    PairSeparation separation(surface, network.positions, scale * kMargin);
    ends.emplace_back(test::run(network, separation, 20, crumpling(scale * kEdge, 5)) / scale);
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
    PairSeparation separation(surface, network.positions, kMargin);
    ends.push_back(test::run(network, separation, 10, crumpling(kEdge, 5)));
  }
  EXPECT_EQ(ends[0], ends[1]);
}

}  // namespace
}  // namespace sprung
