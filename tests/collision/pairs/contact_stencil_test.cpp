// Closest points, separating direction and contact of two convex features.
#include "collision/pairs/contact_stencil.h"

#include "collision/sample_meshes.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace sprung {
namespace {

using test::Random;

struct Placed {
  ContactStencil stencil;
  Points positions;
};

/// Particles numbered from 0.
ContactStencil stencil_of(int first_count, int second_count) {
  ContactStencil stencil{.particles = {}, .first_count = first_count, .second_count = second_count};
  std::iota(stencil.particles.begin(), stencil.particles.end(), 0);
  return stencil;
}

/// Sides above and below a plane across `normal`, `gap` [m] from each other. Some or all corners touch their bound.
Placed sides_across(const Vector3& normal, double gap, int first, int second, Random& random) {
  const Vector3 middle = random.in_box({-Vector3::Ones(), Vector3::Ones()});
  const Vector3 u = normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  Placed sides{.stencil = stencil_of(first, second), .positions = Points(3, first + second)};
  for (int k = 0; k < first + second; ++k) {
    const double away = k == 0 || k == first || random.below(2) == 0 ? 0.0 : random.between(0.0, 0.1);
    const double height = k < first ? 0.5 * gap + away : -0.5 * gap - away;
    sides.positions.col(k) = middle + height * normal + random.between(-0.1, 0.1) * u + random.between(-0.1, 0.1) * v;
  }
  return sides;
}

/// Sides at least 0.1 m apart. Positions are at most 4 m from the origin.
Placed distant_sides(int first, int second, Random& random) {
  Placed sides{.stencil = stencil_of(first, second), .positions = Points(3, first + second)};
  for (double& coordinate : sides.positions.reshaped()) coordinate = random.between(-1.0, 1.0);
  sides.positions.leftCols(first).row(1).array() += 2.1;
  return sides;
}

/// A vertex at a corner of a triangle.
Placed touching_sides() { return {stencil_of(1, 3), (Points(3, 4) << 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0).finished()}; }

class ContactStencilSides : public ::testing::TestWithParam<std::array<int, 2>> {};

// Coordinates of size 1 are rounded to 2^-53, so a gap of 2^-30 is known to 2^-21 of it. The line between the closest points may be
// tilted by as much: over sides of 0.2 that is more than the gap. The normals of faces and edges still keep most of the gap.
TEST_P(ContactStencilSides, KeepMostOfATinyGapAlongTheSeparatingDirection) {
  const auto [first, second] = GetParam();
  Random random(5);
  for (const double gap : {0x1p-10, 0x1p-30, 0x1p-36}) {
    for (int trial = 0; trial < 2000; ++trial) {
      auto [stencil, x] = sides_across(random.direction(), gap, first, second, random);
      stencil.normal = separating_direction(stencil, x);
      EXPECT_GT(heights_at(stencil, x).gap(), 0.5 * gap) << "trial " << trial;
    }
  }
}

// The line between the closest points of two convex sides separates them by their whole distance.
TEST_P(ContactStencilSides, AreSeparatedByTheirDistanceAlongTheClosestPoints) {
  const auto [first, second] = GetParam();
  Random random(7);
  for (int trial = 0; trial < 1000; ++trial) {
    auto [stencil, x] = distant_sides(first, second, random);
    const ContactStencil::PerParticle<Vector3> corners = corners_at(stencil, x);
    const ClosestFeatures closest = closest_points(stencil, corners);
    Vector3 weighted = Vector3::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) weighted += closest.weights[k] * corners[k];
    EXPECT_NEAR((weighted - closest.separation()).norm(), 0.0, 1.0e-12);
    const double distance = closest.separation().norm();
    EXPECT_NEAR(closest.squared_distance, distance * distance, 1.0e-12);
    stencil.normal = closest.separation() / distance;
    EXPECT_NEAR(heights_at(stencil, x).gap(), distance, 1.0e-12);
  }
}

TEST_P(ContactStencilSides, MakeAContactBetweenTheirClosestPoints) {
  const auto [first, second] = GetParam();
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    auto [stencil, x] = distant_sides(first, second, random);
    const auto contact = closest_contact(stencil, x);
    ASSERT_TRUE(contact);
    ASSERT_LE(contact->count, Contact::kMostParticles);
    double sum = 0.0;
    Vector3 separation = Vector3::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact->count); ++k) {
      const bool is_first = contact->particles[k] < first;
      EXPECT_EQ(is_first, contact->weights[k] > 0.0);
      sum += contact->weights[k];
      separation += contact->weights[k] * x.col(contact->particles[k]);
    }
    EXPECT_NEAR(sum, 0.0, 1.0e-8);
    EXPECT_NEAR((separation - contact->distance * contact->normal).norm(), 0.0, 1.0e-8);
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1.0e-14);
    EXPECT_EQ(contact->most_gap, contact->distance);
    stencil.normal = contact->normal;
    EXPECT_NEAR(heights_at(stencil, x).gap(), contact->distance, 1.0e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, ContactStencilSides,
                         ::testing::Values(std::array{1, 3}, std::array{2, 2}, std::array{2, 3}, std::array{3, 3}));

TEST(ContactStencil, HasNoGapAlongTheSeparatingDirectionWhereSidesTouch) {
  auto [stencil, x] = touching_sides();
  stencil.normal = separating_direction(stencil, x);
  EXPECT_LE(heights_at(stencil, x).gap(), 0.0);
}

TEST(ContactStencil, MakesNoContactWhereSidesTouch) {
  const auto [stencil, x] = touching_sides();
  EXPECT_FALSE(closest_contact(stencil, x));
}

}  // namespace
}  // namespace sprung
