#include "dynamics/stretch_newton/coarse_tree.h"

#include "dynamics/networks.h"
#include "dynamics/stretch_newton/component_newton.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <gmock/gmock.h>

#include <numeric>
#include <random>

namespace sprung {
namespace {

using ::testing::ElementsAre;

constexpr double kRounding = 1.0e-12;

StretchComponent only_component(const SpringNetwork& network) {
  return stretch_components(network, {SpringKind::structural}).front();
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double length_of(const StretchComponent& component) {
  double sum = 0.0;
  for (const StretchComponent::Link& link : component.links) sum += link.rest_length;
  return sum;
}

TEST(CoarseTree, OfAChainHasEveryOtherPointAndItsEndsMassAndLength) {
  const StretchComponent fine =
      only_component(make_test_rope(8, 0.0));  // points from the tip: particles 7, 6, ... 1, then the pin 0
  const CoarseTree coarse = coarsen(fine);
  EXPECT_TRUE(coarse.component.is_tree);
  EXPECT_EQ(coarse.component.pin_count(), 1);
  // The last free point is linked to the pin.
  EXPECT_THAT(coarse.component.points, ElementsAre(0, 2, 4, 6, 7));
  EXPECT_NEAR(sum_of(coarse.component.masses), sum_of(fine.masses), kRounding);
  EXPECT_NEAR(length_of(coarse.component), length_of(fine), kRounding);
}

TEST(CoarseTree, KeepsForksEndsAndWhatIsLinkedToPins) {
  StretchComponent fork;  // 0 and 1 hang on 2, and 2 on 3 and 4; 5 is a pin
  fork.points = {10, 11, 12, 13, 14, 15};
  fork.free_count = 5;
  fork.masses.assign(5, 1.0);
  fork.is_tree = true;
  fork.links = {{0, 2, 1.0, 0}, {1, 2, 1.0, 1}, {2, 3, 1.0, 2}, {3, 4, 1.0, 3}, {4, 5, 1.0, 4}};
  fork.begin = {0, 1, 2, 3, 4, 5};
  const CoarseTree coarse = coarsen(fork);
  EXPECT_THAT(coarse.component.points, ElementsAre(0, 1, 2, 4, 5));
  ASSERT_EQ(coarse.between.size(), 1u);
  EXPECT_EQ(coarse.between[0].point, 3);
  EXPECT_THAT(coarse.component.masses, ElementsAre(1.0, 1.0, 1.5, 1.5));
}

// Against the best of many random places that satisfy both limits.
TEST(CoarseTree, PutsOtherPointsAtTheNearestPlaceWithinBothLimits) {
  constexpr double kMaxStretch = 0.1;
  CoarseTree tree;
  tree.between = {{.point = 1, .ends = {0, 2}, .lengths = {1.0, 2.0}}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-3.5, 3.5);
  const auto within = [&](const Points& x, const Vector3& at, double rounding) {
    return (at - x.col(0)).norm() <= 1.0 + kMaxStretch + rounding && (at - x.col(2)).norm() <= 2.0 * (1.0 + kMaxStretch) + rounding;
  };
  int tried = 0;
  for (int i = 0; i < 400; ++i) {
    Points x = Points::NullaryExpr(3, 3, [&] { return place(random); });
    const double apart = (x.col(2) - x.col(0)).norm();
    if (apart > 3.0 * (1.0 + kMaxStretch)) continue;
    ++tried;
    const Points target = x;
    tree.place_others(target, kMaxStretch, x);
    const Vector3 wanted = target.col(1);
    ASSERT_TRUE(within(x, x.col(1), kRounding)) << i;
    for (int k = 0; k < 300; ++k) {
      const Vector3 other = Vector3::NullaryExpr([&] { return place(random); });
      if (!within(x, other, 0.0)) continue;
      EXPECT_GE((other - wanted).norm(), (x.col(1) - wanted).norm() - kRounding) << i;
    }
  }
  EXPECT_GT(tried, 50);
}

TEST(CoarseTree, DividesALinkThatIsTooLong) {
  CoarseTree tree;
  tree.between = {{.point = 1, .ends = {0, 2}, .lengths = {1.0, 3.0}}};
  Points x = Points::Zero(3, 3);
  x.col(2) << 8.0, 0.0, 0.0;
  Points target = x;
  target.col(1) << 1.0, 5.0, 0.0;
  tree.place_others(target, 0.0, x);
  EXPECT_NEAR(x(0, 1), 2.0, kRounding);
  EXPECT_NEAR(x(1, 1), 0.0, kRounding);
}

// A comb has nothing that can be left out, and a chain of 2^12 links has little on the coarsest level.
TEST(CoarseTree, OfACombIsTheComb) {
  StretchComponent comb;
  constexpr Index kTeeth = 40;
  comb.is_tree = true;
  comb.free_count = 2 * kTeeth;
  for (Index i = 0; i < kTeeth; ++i) {
    comb.links.push_back({2 * i, 2 * i + 1, 1.0, 2 * i});
    comb.begin.push_back(2 * i + 1);
    comb.links.push_back({2 * i + 1, i + 1 < kTeeth ? 2 * i + 3 : 2 * kTeeth, 1.0, 2 * i + 1});
    comb.begin.push_back(2 * i + 2);
  }
  comb.masses.assign(comb.free_count, 1.0);
  for (Index i = 0; i <= comb.free_count; ++i) comb.points.push_back(i);
  EXPECT_LE(coarsen(comb).between.size(), 1u);

  Points before(3, comb.free_count + 1);
  for (Index i = 0; i < kTeeth; ++i) {
    before.col(2 * i) << 0.0, 1.0, static_cast<double>(kTeeth - i);
    before.col(2 * i + 1) << 0.0, 0.0, static_cast<double>(kTeeth - i);
  }
  before.col(2 * kTeeth).setZero();
  Points x = before;
  x.leftCols(comb.free_count).row(0).array() += 0.5;
  ASSERT_TRUE(ComponentNewton(comb, {}).solve(before, x, 0.5));
  EXPECT_TRUE(x.allFinite());
}

}  // namespace
}  // namespace sprung
