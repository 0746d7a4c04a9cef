// What turning planes are said to keep apart does not cross on its way, and what gives way is kept apart.
#include "collision/giving_way.h"
#include "collision/sample_meshes.h"
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

using test::Random;

constexpr GapRule kRule{.thickness_kept = 1e-3, .clearance = 1e-9};
constexpr int kTimes = 64;

/// Two triangles, or two segments, a gap of up to a hundredth of their size apart.
struct Meeting {
  ElementPair pair;
  Points before;
};

Meeting random_meeting(int side, Random& random) {
  const Vector3 normal = random.direction();
  const Vector3 u = normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  const double gap = std::pow(10.0, random.between(-7.0, -2.0));
  Meeting meeting{.pair = {.first_count = side, .second_count = side}, .before = Points(3, 2 * side)};
  for (int k = 0; k < 2 * side; ++k) {
    const double away = k == 0 || k == side ? 0.0 : random.between(0.0, 0.2);
    const double height = k < side ? 0.5 * gap + away : -0.5 * gap - away;
    meeting.before.col(k) = height * normal + random.between(-1.0, 1.0) * u + random.between(-1.0, 1.0) * v;
    meeting.pair.particles[static_cast<std::size_t>(k)] = k;
  }
  meeting.pair.normal = direction_between(meeting.pair, meeting.before);
  return meeting;
}

/// They turn by `angle` about any axis, and each goes up to `stray` [m] elsewhere.
Points random_ends(const Points& before, double angle, double stray, Random& random) {
  const Matrix3 turn = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
  Points ends = turn * before;
  for (Index i = 0; i < static_cast<Index>(ends.cols()); ++i) ends.col(i) += random.between(0.0, stray) * random.direction();
  return ends;
}

/// Whether an edge of one meets the other triangle at one of many times on the way.
bool cross_on_the_way(const Points& before, const Points& ends) {
  for (int k = 0; k <= kTimes; ++k) {
    const double time = static_cast<double>(k) / kTimes;
    const Points x = (1.0 - time) * before + time * ends;
    for (const int first : {0, 3}) {
      const int second = 3 - first;
      for (int e = 0; e < 3; ++e) {
        if (test::segment_meets_triangle(x.col(first + e), x.col(first + (e + 1) % 3), x.col(second), x.col(second + 1),
                                         x.col(second + 2))) {
          return true;
        }
      }
    }
  }
  return false;
}

TEST(GivingWay, WhatItsPlanesKeepApartDoesNotCrossOnTheWay) {
  Random random(1);
  int kept = 0;
  int crossed = 0;
  const std::vector<char> pinned(6, 0);
  for (int n = 0; n < 20000; ++n) {
    const Meeting meeting = random_meeting(3, random);
    const Points ends = random_ends(meeting.before, random.between(0.0, 0.5), std::pow(10.0, random.between(-5.0, 0.3)), random);
    const bool crosses = cross_on_the_way(meeting.before, ends);
    crossed += crosses ? 1 : 0;
    if (GivingWay(meeting.before, pinned, kRule).passes(meeting.pair, ends)) continue;
    ++kept;
    ASSERT_FALSE(crosses) << n;
  }
  EXPECT_GT(kept, 5000);
  EXPECT_GT(crossed, 1000);
}

// With the angle t, axis u, normal n and a way d from side to side the gap midway is cos(t) n.d + (1 - cos(t)) (n.u) (u.d), of
// which the last is at most t^2 |d| / 4, with |d| < 3. A plane of which the normal stays would need a gap of t |d|.
TEST(GivingWay, WhatTurnsTogetherDoesNotPass) {
  Random random(2);
  for (const int side : {2, 3}) {
    const std::vector<char> pinned(static_cast<std::size_t>(2 * side), 0);
    for (int n = 0; n < 1000; ++n) {
      const Meeting meeting = random_meeting(side, random);
      const double gap = heights_at(meeting.pair, meeting.before).gap();
      const Points ends = random_ends(meeting.before, std::min(0.5, std::sqrt(gap)), 0.0, random);
      EXPECT_FALSE(GivingWay(meeting.before, pinned, kRule).passes(meeting.pair, ends)) << side << ", " << n;
    }
  }
}

// A particle between the pins of two sheets that close in on it from both sides, but leave it room.
TEST(GivingWay, AParticleBetweenPinsGoesWhereTheyLeaveRoom) {
  Points before(3, 7);
  before << 0.0, -1.0, 1.0, 0.0, -1.0, 1.0, 0.0,  //
      0.5, 0.5, 0.5, -0.5, -0.5, -0.5, 0.45,      //
      1.0, -1.0, -1.0, 1.0, -1.0, -1.0, 0.0;
  Points ends = before;
  ends.row(1).head(3).setConstant(-0.3);
  const std::vector<char> pinned{1, 1, 1, 1, 1, 1, 0};
  std::vector<ElementPair> pairs(2);
  pairs[0] = {.particles = {6, 0, 1, 2}, .first_count = 1, .second_count = 3, .normal = -Vector3::UnitY()};
  pairs[1] = {.particles = {6, 3, 4, 5}, .first_count = 1, .second_count = 3, .normal = Vector3::UnitY()};
  const GivingWay way(before, pinned, kRule);
  ASSERT_TRUE(way.passes(pairs[0], ends));
  EXPECT_EQ(way.move_apart(pairs, ends), std::vector<Index>{6});
  for (const ElementPair& pair : pairs) EXPECT_FALSE(way.passes(pair, ends));
  EXPECT_LT(ends(1, 6), -0.3);
  EXPECT_GT(ends(1, 6), -0.5);
}

TEST(GivingWay, PinsAreNotMoved) {
  Points before(3, 4);
  before << 0.0, 0.0, -1.0, 1.0,  //
      0.1, 0.0, 0.0, 0.0,         //
      0.0, 1.0, -1.0, -1.0;
  Points ends = before;
  ends(1, 0) = -0.1;
  const std::vector<char> pinned(4, 1);
  const std::vector<ElementPair> pairs{
      {.particles = {0, 1, 2, 3}, .first_count = 1, .second_count = 3, .normal = Vector3::UnitY()}};
  const GivingWay way(before, pinned, kRule);
  const Points asked = ends;
  EXPECT_TRUE(way.move_apart(pairs, ends).empty());
  EXPECT_EQ(ends, asked);
  EXPECT_TRUE(way.passes(pairs[0], ends));
}

}  // namespace
}  // namespace sprung
