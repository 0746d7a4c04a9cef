#include "network/step_adjustment.h"

#include "network/bodies/shape_parts.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprung {
namespace {

using testing::HasSubstr;

/// A chain along x of springs of 100 N/m and 1 N s/m between particles of 1 kg, 1 m apart.
BodyShape make_chain(Index particles) {
  std::vector<Vector3> positions;
  for (Index i = 0; i < particles; ++i) positions.emplace_back(static_cast<double>(i), 0.0, 0.0);
  BodyShape shape = shape_of_particles(std::move(positions), {});
  std::ranges::fill(shape.masses, 1.0);
  for (Index i = 0; i + 1 < particles; ++i) shape.springs.append(i, i + 1, 1.0, 100.0, 1.0, SpringKind::structural);
  return shape;
}

double total_mass(const BodyShape& shape) { return std::accumulate(shape.masses.begin(), shape.masses.end(), 0.0); }

TEST(StepAdjustment, LeavesEvenBodiesAsTheyAre) {
  BodyShape shape = make_chain(300);
  EXPECT_FALSE(adjust_for_step(shape, 0.01));
  EXPECT_EQ(total_mass(shape), 300.0);
}

// A spring of 400 times the stiffness needs a step of a twentieth; afterwards it needs half the step of the others.
TEST(StepAdjustment, SoftensASpringUntilItNeedsHalfTheStepOfTheOthers) {
  BodyShape shape = make_chain(300);
  shape.springs.stiffness[150] = 40000.0;
  shape.springs.damping[150] = 400.0;
  const auto adjustment = adjust_for_step(shape, 0.01);
  ASSERT_TRUE(adjustment);
  EXPECT_EQ(adjustment->softened, 1);
  EXPECT_NEAR(adjustment->least_factor, 0.01, 1e-12);
  EXPECT_NEAR(shape.springs.stiffness[150], 400.0, 1e-9);
  EXPECT_NEAR(shape.springs.damping[150], 4.0, 1e-11);
  EXPECT_EQ(shape.springs.stiffness[149], 100.0);
  EXPECT_EQ(adjustment->from, Vector3(150.0, 0.0, 0.0));
  EXPECT_EQ(adjustment->to, Vector3(151.0, 0.0, 0.0));
  EXPECT_EQ(adjustment->heavier, 0);
  EXPECT_EQ(total_mass(shape), 300.0);
}

TEST(StepAdjustment, LeavesSmallBodiesAsTheyAre) {
  BodyShape shape = make_chain(kLeastAdjusted - 1);
  shape.springs.stiffness[50] = 40000.0;
  EXPECT_FALSE(adjust_for_step(shape, 0.01));
  BodyShape large = make_chain(kLeastAdjusted);
  large.springs.stiffness[50] = 40000.0;
  EXPECT_TRUE(adjust_for_step(large, 0.01));
}

// A particle of 1/2 kg with 42 springs of 100 N/m, none of which is fast on its own. Their row sum is 42 * 2 * 100 N/m; the forty
// particles at their other ends, 4 in 100, have 6 * 100 N/m / 1 kg. Four times that is right for a mass of 3.5 kg.
BodyShape make_hub() {
  BodyShape shape = make_chain(1000);
  shape.masses[500] = 0.5;
  for (Index k = 0; k < 40; ++k) shape.springs.append(500, 10 + 20 * k, 1.0, 100.0, 1.0, SpringKind::shear);
  return shape;
}

TEST(StepAdjustment, AddsMassWhereAllElementsTogetherActTooFast) {
  BodyShape shape = make_hub();
  const double before = total_mass(shape);
  const auto adjustment = adjust_for_step(shape, 0.01);
  ASSERT_TRUE(adjustment);
  EXPECT_EQ(adjustment->softened, 0);
  EXPECT_EQ(adjustment->heavier, 1);
  EXPECT_NEAR(shape.masses[500], 3.5, 1e-12);
  EXPECT_EQ(shape.masses[499], 1.0);
  EXPECT_NEAR(adjustment->added_mass, total_mass(shape) - before, 1e-9);
  EXPECT_TRUE(adjustment->from.x() == 500.0 || adjustment->to.x() == 500.0);
}

TEST(StepAdjustment, AddsNoMoreThanItsShareAndNothingWithout) {
  BodyShape shape = make_hub();
  const double before = total_mass(shape);
  const auto adjustment = adjust_for_step(shape, 0.001);
  ASSERT_TRUE(adjustment);
  EXPECT_LE(adjustment->added_mass, 0.001 * before * (1.0 + 1e-12));
  EXPECT_GE(adjustment->added_mass, 0.000999 * before);
  BodyShape none = make_hub();
  EXPECT_FALSE(adjust_for_step(none, 0.0));
}

// The slivers of a mesh of tetrahedra: a tenth of all particles have 1e-9 kg and springs of 0.001 N/m. Their row sum is
// 4 * 0.001 N/m, that of the others 4 * 100 N/m / 1 kg. Four times that is right for 2.5e-6 kg.
TEST(StepAdjustment, AddsMassToManyParticlesThatWeighNextToNothing) {
  BodyShape shape = make_chain(1000);
  std::fill(shape.masses.begin() + 900, shape.masses.end(), 1e-9);
  std::fill(shape.springs.stiffness.begin() + 899, shape.springs.stiffness.end(), 1e-3);
  const auto adjustment = adjust_for_step(shape, 0.01);
  ASSERT_TRUE(adjustment);
  EXPECT_EQ(adjustment->softened, 0);
  EXPECT_EQ(adjustment->heavier, 100);
  EXPECT_NEAR(shape.masses[950], 2.5e-6, 1e-18);
  EXPECT_EQ(shape.masses[899], 1.0);
}

TEST(StepAdjustment, SoftensAngleBendsOfShortBonds) {
  BodyShape shape = make_chain(300);
  for (Index i = 0; i + 2 < 300; ++i) shape.angle_bends.append({i, i + 1, i + 2}, {1.0, 1.0}, 10.0, 0.1);
  shape.angle_bends.length_after[70] = 0.01;  // k / l^2 grows by 1e4
  const auto adjustment = adjust_for_step(shape, 0.01);
  ASSERT_TRUE(adjustment);
  EXPECT_EQ(adjustment->softened, 1);
  EXPECT_LT(shape.angle_bends.stiffness[70], 0.1);
  EXPECT_NEAR(shape.angle_bends.damping[70] / shape.angle_bends.stiffness[70], 0.01, 1e-12);
  EXPECT_EQ(adjustment->from, Vector3(71.0, 0.0, 0.0));
  EXPECT_EQ(adjustment->to, Vector3(72.0, 0.0, 0.0));
}

TEST(StepAdjustment, SaysWhatChangedAndWhere) {
  BodyShape shape = make_hub();
  shape.springs.stiffness[150] = 1e6;
  auto adjustment = adjust_for_step(shape, 0.01);
  ASSERT_TRUE(adjustment);
  adjustment->body = "sheet";
  const std::string text = describe(*adjustment);
  for (const char* part : {"body \"sheet\"", "softer", "heavier", "% of the body", "from [150, 0, 0] to [151, 0, 0], 1 m long"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

}  // namespace
}  // namespace sprung
