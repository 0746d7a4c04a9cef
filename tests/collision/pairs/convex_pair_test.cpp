// The direction between two convex parts of the network.
#include "collision/pairs/convex_pair.h"
#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <vector>

namespace sprung {
namespace {

using test::Random;

struct Sides {
  ConvexPair pair;
  Points positions;
};

/// Sides whose corners are above and below a plane across `normal`, `gap` [m] from each other; some or all touch their end of it.
Sides sides_across(const Vector3& normal, double gap, int first, int second, Random& random) {
  const Vector3 middle = random.in_box({-Vector3::Ones(), Vector3::Ones()});
  const Vector3 u = normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  Sides sides{.pair = {.first_count = first, .second_count = second}, .positions = Points(3, first + second)};
  for (int k = 0; k < first + second; ++k) {
    const double away = k == 0 || k == first || random.below(2) == 0 ? 0.0 : random.between(0.0, 0.1);
    const double height = k < first ? 0.5 * gap + away : -0.5 * gap - away;
    sides.positions.col(k) = middle + height * normal + random.between(-0.1, 0.1) * u + random.between(-0.1, 0.1) * v;
    sides.pair.particles[static_cast<std::size_t>(k)] = k;
  }
  return sides;
}

/// Coordinates of size 1 are rounded to 2^-53, so that a gap of 2^-30 is known to 2^-21 of it, while the line between nearest
/// points may be turned by as much: over sides of 0.2 that is more than the gap itself. What is left of the gap along features'
/// normals, or along the line across an edge, is most of it.
TEST(DirectionBetween, SeparatesWhatHardlyRoundingTellsApart) {
  Random random(5);
  for (const auto& [first, second] : std::vector<std::pair<int, int>>{{1, 3}, {2, 3}, {3, 3}, {2, 2}}) {
    for (const double gap : {0x1p-10, 0x1p-30, 0x1p-36}) {
      for (int trial = 0; trial < 2000; ++trial) {
        Sides sides = sides_across(random.direction(), gap, first, second, random);
        sides.pair.normal = direction_between(sides.pair, sides.positions);
        EXPECT_GT(heights_at(sides.pair, sides.positions).gap(), 0.5 * gap)
            << first << " against " << second << ", trial " << trial;
      }
    }
  }
}

TEST(DirectionBetween, LeavesNoGapWhereSidesTouch) {
  ConvexPair pair{.particles = {0, 1, 2, 3}, .first_count = 1, .second_count = 3};
  Points positions(3, 4);
  positions << 0, 0, 1, 0,  //
      0, 0, 0, 1,           //
      0, 0, 0, 0;
  pair.normal = direction_between(pair, positions);
  EXPECT_LE(heights_at(pair, positions).gap(), 0.0);
}

}  // namespace
}  // namespace sprung
