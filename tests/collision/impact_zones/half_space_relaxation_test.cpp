// Sides that rotating planes separate do not cross, and relaxation separates sides.
#include "collision/impact_zones/half_space_relaxation.h"
#include "collision/nearby_sides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::cross_in_between;
using test::NearbySides;
using test::Random;
using test::random_ends;
using test::random_nearby_sides;

constexpr SeparationTolerance kTolerance{.thickness_kept = 1e-3, .clearance = 1e-9};

TEST(HalfSpaceRelaxation, SidesThatAPlaneSeparatesDoNotCross) {
  Random random(1);
  int kept = 0;
  int crossed = 0;
  const ParticleMotions motions(6);
  for (int n = 0; n < 20000; ++n) {
    const NearbySides sides = random_nearby_sides(3, random);
    const Points ends = random_ends(sides.before, random.between(0.0, 0.5), std::pow(10.0, random.between(-5.0, 0.3)), random);
    const bool crosses = cross_in_between(sides.before, ends);
    crossed += crosses ? 1 : 0;
    if (HalfSpaceRelaxation(sides.before, motions, kTolerance).passes(sides.pair, ends)) continue;
    ++kept;
    ASSERT_FALSE(crosses) << n;
  }
  EXPECT_GT(kept, 5000);
  EXPECT_GT(crossed, 1000);
}

// For the angle t, axis u, normal n and a vector d from side to side, the middle coefficient of the gap is
// cos(t) n.d + (1 - cos(t)) (n.u) (u.d). Its last term is at most t^2 |d| / 4, with |d| < 3. A plane with a constant normal would
// need a gap of t |d|.
TEST(HalfSpaceRelaxation, SidesThatRotateTogetherDoNotPass) {
  Random random(2);
  for (const int side : {2, 3}) {
    const ParticleMotions motions(static_cast<std::size_t>(2 * side));
    for (int n = 0; n < 1000; ++n) {
      const NearbySides sides = random_nearby_sides(side, random);
      const double gap = heights_at(sides.pair, sides.before).gap();
      const Points ends = random_ends(sides.before, std::min(0.5, std::sqrt(gap)), 0.0, random);
      EXPECT_FALSE(HalfSpaceRelaxation(sides.before, motions, kTolerance).passes(sides.pair, ends)) << side << ", " << n;
    }
  }
}

// The pins of two sheets approach a particle from both sides, but leave it room.
TEST(HalfSpaceRelaxation, AParticleBetweenPinsMovesToWhereTheyLeaveRoom) {
  Points before(3, 7);
  before << 0.0, -1.0, 1.0, 0.0, -1.0, 1.0, 0.0,  //
      0.5, 0.5, 0.5, -0.5, -0.5, -0.5, 0.45,      //
      1.0, -1.0, -1.0, 1.0, -1.0, -1.0, 0.0;
  Points ends = before;
  ends.row(1).head(3).setConstant(-0.3);
  ParticleMotions motions(7, ParticleMotion::driven);
  motions.back() = ParticleMotion::free;
  std::vector<ContactStencil> pairs(2);
  pairs[0] = {.particles = {6, 0, 1, 2}, .first_count = 1, .second_count = 3, .normal = -Vector3::UnitY()};
  pairs[1] = {.particles = {6, 3, 4, 5}, .first_count = 1, .second_count = 3, .normal = Vector3::UnitY()};
  const HalfSpaceRelaxation relaxation(before, motions, kTolerance);
  ASSERT_TRUE(relaxation.passes(pairs[0], ends));
  EXPECT_EQ(relaxation.move_apart(pairs, ends), std::vector<Index>{6});
  for (const ContactStencil& pair : pairs) EXPECT_FALSE(relaxation.passes(pair, ends));
  EXPECT_LT(ends(1, 6), -0.3);
  EXPECT_GT(ends(1, 6), -0.5);
}

TEST(HalfSpaceRelaxation, PinsAreNotMoved) {
  Points before(3, 4);
  before << 0.0, 0.0, -1.0, 1.0,  //
      0.1, 0.0, 0.0, 0.0,         //
      0.0, 1.0, -1.0, -1.0;
  Points ends = before;
  ends(1, 0) = -0.1;
  const ParticleMotions motions(4, ParticleMotion::driven);
  const std::vector<ContactStencil> pairs{
      {.particles = {0, 1, 2, 3}, .first_count = 1, .second_count = 3, .normal = Vector3::UnitY()}};
  const HalfSpaceRelaxation relaxation(before, motions, kTolerance);
  const Points requested = ends;
  EXPECT_TRUE(relaxation.move_apart(pairs, ends).empty());
  EXPECT_EQ(ends, requested);
  EXPECT_TRUE(relaxation.passes(pairs[0], ends));
}

}  // namespace
}  // namespace sprung
