// Which contacts are found: how near, and what is looked for again.
#include "collision/single_particles.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sprung {
namespace {

constexpr double kGap = 0.01;  // [m]

/// Contacts with a floor of this gap, of particles on their way down to these heights [gaps] by so much [gaps]; found half a gap
/// beyond it at most.
std::size_t contacts(const std::vector<double>& heights, const std::vector<double>& falls) {
  Environment environment({{.name = "floor",
                            .geometry = HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = 0.0},
                            .material = {.thickness = kGap}}});
  environment.set_interval(0.0, 0.01);
  StepTruncation space = test::single_particles(environment, std::vector<char>(heights.size(), 0), 0.5 * kGap);
  Points after = Points::Zero(3, static_cast<Index>(heights.size()));
  Points before = after;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    after(1, static_cast<Index>(i)) = heights[i] * kGap;
    before(1, static_cast<Index>(i)) = (heights[i] + falls[i]) * kGap;
  }
  space.begin_step(before, after);
  return space.contacts(before, after).size();
}

/// The largest height [gaps] from 1 on, in steps of a hundredth, at which contact is found after this fall [gaps], while a second
/// particle high above falls by so much.
double reach(double fall, double fall_of_other = 0.0) {
  double height = 0.99;
  while (contacts({height + 0.01, 5.0}, {fall, fall_of_other}) > 0) height += 0.01;
  return height;
}

TEST(ContactMargin, OfWhatRestsIsPositiveAndLessThanAsked) {
  EXPECT_GT(reach(0.0), 1.0);
  EXPECT_LT(reach(0.0), 1.45);
}

TEST(ContactMargin, GrowsWithTheMotionUpToWhatIsAsked) {
  EXPECT_GT(reach(0.2), reach(0.0));
  EXPECT_GT(reach(0.4), reach(0.2));
  EXPECT_NEAR(reach(8.0), 1.5, 0.011);
  EXPECT_EQ(reach(80.0), reach(8.0));
}

TEST(ContactMargin, CountsTheMotionOfNeighbours) {
  EXPECT_GT(reach(0.0, 0.4), reach(0.0));
  EXPECT_GE(reach(0.4), reach(0.0, 0.4)) << "but its own no less";
}

// Of two patches of particles that touch, all but the first particle, which falls through the floor and is stopped, go where
// nothing is: its own patch is looked at again.
TEST(ContactsAgain, AreFoundAnewAroundWhatWasStopped) {
  constexpr Index kParticles = 40;  // more than a patch may have, which are halved
  Environment environment({{.name = "floor",
                            .geometry = HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = 0.0},
                            .material = {.thickness = kGap}}});
  environment.set_interval(0.0, 0.01);
  StepTruncation space = test::single_particles(environment, std::vector<char>(kParticles, 0), 0.5 * kGap);
  Points before = Points::Zero(3, kParticles);
  before.row(1).setConstant(kGap);
  Points after = before;
  after(1, 0) = -kGap;
  space.begin_step(before, after);
  const std::vector<Contact>& found = space.contacts(before, after);
  EXPECT_EQ(found.size(), kParticles);
  EXPECT_EQ(std::ranges::count(found, 0, &Contact::patch), kParticles / 2);
  EXPECT_EQ(std::ranges::count(found, 1, &Contact::patch), kParticles / 2);
  std::vector<Contact> again;
  std::vector<Index> patches;
  space.truncate(before, after, [&](Points& positions) {
    if (!again.empty()) return false;
    positions.row(1).tail(kParticles - 1).array() += 4.0 * kGap;
    FreshContacts fresh = space.renewed_contacts(before, positions);
    again = std::move(fresh.contacts);
    patches = std::move(fresh.patches);
    return true;
  });
  EXPECT_EQ(patches, std::vector<Index>{0});
  ASSERT_EQ(again.size(), 1);
  EXPECT_EQ(again.front().particles[0], 0);
  EXPECT_EQ(again.front().patch, 0);
  EXPECT_GT(again.front().distance, 0.0);
}

TEST(ContactMargin, DoesNotMatterToWhatFallsThrough) { EXPECT_EQ(contacts({-3.0}, {8.0}), 1U); }

}  // namespace
}  // namespace sprung
