// Distance up to which contacts are found, and contacts renewed after a truncation.
#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

constexpr double kGap = 0.01;  // [m]

/// Number of contacts with a floor of this gap. Particles end at `heights` [gaps] after a descent of `falls` [gaps]. The margin is
/// half a gap.
std::size_t contacts(const std::vector<double>& heights, const std::vector<double>& falls) {
  const ObstacleSet obstacles({{.name = "floor",
                                .geometry = HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = 0.0},
                                .material = {.thickness = kGap}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.01);
  StepTruncation truncation = test::single_particles(obstacles, ParticleMotions(heights.size()), 0.5 * kGap);
  Points after = Points::Zero(3, static_cast<Index>(heights.size()));
  Points before = after;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    after(1, static_cast<Index>(i)) = heights[i] * kGap;
    before(1, static_cast<Index>(i)) = (heights[i] + falls[i]) * kGap;
  }
  truncation.begin_step(frame, before, after);
  return truncation.contacts(frame, before, after).size();
}

/// The largest height [gaps], from 1 in steps of 0.01, at which a particle has a contact after a descent of `fall` [gaps]. A
/// second particle, high above, descends by `fall_of_other` [gaps].
double reach(double fall, double fall_of_other = 0.0) {
  double height = 0.99;
  while (contacts({height + 0.01, 5.0}, {fall, fall_of_other}) > 0) height += 0.01;
  return height;
}

TEST(ContactMargin, AParticleAtRestHasAPositiveMarginBelowTheRequestedOne) {
  EXPECT_GT(reach(0.0), 1.0);
  EXPECT_LT(reach(0.0), 1.45);
}

TEST(ContactMargin, TheMarginGrowsWithTheMotionUpToTheRequestedOne) {
  EXPECT_GT(reach(0.2), reach(0.0));
  EXPECT_GT(reach(0.4), reach(0.2));
  EXPECT_NEAR(reach(8.0), 1.5, 0.011);
  EXPECT_EQ(reach(80.0), reach(8.0));
}

TEST(ContactMargin, TheMarginIncludesTheMotionOfNeighbours) {
  EXPECT_GT(reach(0.0, 0.4), reach(0.0));
  EXPECT_GE(reach(0.4), reach(0.0, 0.4)) << "the particle's own motion counts as much";
}

// Two neighbouring patches. The first particle crosses the floor and is truncated. All others move away, and only the patch of the
// first one is searched again.
TEST(RenewedContacts, AreFoundInThePatchOfATruncatedParticle) {
  constexpr Index kParticles = 40;  // more than fit in one patch, so there are two halves
  const ObstacleSet obstacles({{.name = "floor",
                                .geometry = HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = 0.0},
                                .material = {.thickness = kGap}}});
  const ObstacleFrame frame(obstacles, 0.0, 0.01);
  StepTruncation truncation = test::single_particles(obstacles, ParticleMotions(kParticles), 0.5 * kGap);
  Points before = Points::Zero(3, kParticles);
  before.row(1).setConstant(kGap);
  Points after = before;
  after(1, 0) = -kGap;
  truncation.begin_step(frame, before, after);
  const std::vector<Contact>& found = truncation.contacts(frame, before, after);
  EXPECT_EQ(found.size(), kParticles);
  EXPECT_EQ(std::ranges::count(found, 0, &Contact::patch), kParticles / 2);
  EXPECT_EQ(std::ranges::count(found, 1, &Contact::patch), kParticles / 2);
  std::vector<Contact> renewed;
  std::vector<Index> patches;
  truncation.truncate(frame, before, after, [&](Points& positions) {
    if (!renewed.empty()) return false;
    positions.row(1).tail(kParticles - 1).array() += 4.0 * kGap;
    FreshContacts fresh = truncation.renewed_contacts(frame, before, positions);
    renewed = std::move(fresh.contacts);
    patches = std::move(fresh.patches);
    return true;
  });
  EXPECT_EQ(patches, std::vector<Index>{0});
  ASSERT_EQ(renewed.size(), 1);
  EXPECT_EQ(renewed.front().particles[0], 0);
  EXPECT_EQ(renewed.front().patch, 0);
  EXPECT_GT(renewed.front().distance, 0.0);
}

TEST(ContactMargin, AParticleThatFallsThroughIsInContact) { EXPECT_EQ(contacts({-3.0}, {8.0}), 1U); }

}  // namespace
}  // namespace sprung
