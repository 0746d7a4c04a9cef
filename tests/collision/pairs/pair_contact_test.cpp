#include "collision/pairs/pair_contact.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace sprung {
namespace {

/// Sides of so many corners each, 0.1 m and more apart.
ConvexPair random_pair(int first_count, int second_count, std::mt19937& random, Points& positions) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  ConvexPair pair{.particles = {}, .first_count = first_count, .second_count = second_count};
  std::iota(pair.particles.begin(), pair.particles.end(), 0);
  positions = Points::Zero(3, pair.count());
  for (double& coordinate : positions.reshaped()) coordinate = unit(random);
  positions.leftCols(first_count).row(1).array() += 2.1;
  return pair;
}

class MeetingOfAPair : public ::testing::TestWithParam<std::array<int, 2>> {};

// Of two convex sides the nearest points' line is the direction that separates them by all of their distance. Positions are at most
// 4 m from the origin.
TEST_P(MeetingOfAPair, IsWhereItsSidesAreNearest) {
  const auto [first_count, second_count] = GetParam();
  std::mt19937 random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    Points x;
    ConvexPair pair = random_pair(first_count, second_count, random, x);
    const auto meeting = meeting_of(pair, x);
    ASSERT_TRUE(meeting);
    ASSERT_LE(meeting->count, Contact::kMostParticles);
    double sum = 0.0;
    Vector3 between = Vector3::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(meeting->count); ++k) {
      const bool is_first = meeting->particles[k] < first_count;
      EXPECT_EQ(is_first, meeting->weights[k] > 0.0);
      sum += meeting->weights[k];
      between += meeting->weights[k] * x.col(meeting->particles[k]);
    }
    EXPECT_NEAR(sum, 0.0, 1.0e-8);
    EXPECT_NEAR((between - meeting->distance * meeting->normal).norm(), 0.0, 1.0e-8);
    EXPECT_NEAR(meeting->normal.norm(), 1.0, 1.0e-14);
    EXPECT_EQ(meeting->most_gap, meeting->distance);
    pair.normal = meeting->normal;
    EXPECT_NEAR(heights_at(pair, x).gap(), meeting->distance, 1.0e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, MeetingOfAPair,
                         ::testing::Values(std::array{1, 3}, std::array{2, 2}, std::array{2, 3}, std::array{3, 3}));

TEST(MeetingOfAPair, IsNoneWhereTheyTouch) {
  const Points x = (Points(3, 4) << 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0).finished();
  const ConvexPair pair{.particles = {0, 1, 2, 3}, .first_count = 1, .second_count = 3};
  EXPECT_FALSE(meeting_of(pair, x));
}

}  // namespace
}  // namespace sprung
