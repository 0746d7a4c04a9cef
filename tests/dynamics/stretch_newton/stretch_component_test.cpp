#include "dynamics/stretch_newton/stretch_component.h"

#include "dynamics/networks.h"
#include "dynamics/tethers/limited_springs.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using ::testing::ElementsAre;

std::vector<StretchComponent> structural(const SpringNetwork& network) {
  return stretch_components(network, {SpringKind::structural});
}

TEST(StretchComponents, ARopeIsATreeFromItsTipToItsPin) {
  const auto found = structural(make_test_rope(4, 0.0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_tree);
  EXPECT_THAT(found[0].points, ElementsAre(3, 2, 1, 0));
  EXPECT_EQ(found[0].free_count, 3);
  EXPECT_THAT(found[0].begin, ElementsAre(0, 1, 2, 3));
}

TEST(StretchComponents, PinsSeparateThem) {
  SpringNetwork network = make_test_rope(7, 0.0);
  network.inverse_masses[3] = 0.0;
  const auto found = structural(network);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].points, ::testing::UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(found[1].points, ElementsAre(6, 5, 4, 3));
}

TEST(StretchComponents, RodsJoinThemAndRodsAloneMakeNone) {
  SpringNetwork network = make_test_rope(7, 0.0);
  network.inverse_masses[3] = 0.0;
  const RodRow rod{.particles = {1, 5}, .weights = {1.0, -1.0}, .count = 2, .length = 1.0, .tolerance = 1e-3};
  const std::vector<RodRow> rods = {rod};
  const auto found = stretch_components(network, limited_springs(network, {SpringKind::structural}), rods);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].points, ::testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_FALSE(found[0].is_tree);
  ASSERT_EQ(found[0].rods.size(), 1u);
  EXPECT_EQ(found[0].points[found[0].rods[0].points[1]], 5);
  EXPECT_TRUE(stretch_components(network, std::vector<Index>(), rods).empty());
}

TEST(StretchComponents, ARopeBetweenTwoPinsIsATree) {
  SpringNetwork network = make_test_rope(5, 0.0);
  network.inverse_masses[4] = 0.0;
  const auto found = structural(network);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_tree);
  EXPECT_EQ(found[0].pin_count(), 2);
}

TEST(StretchComponents, AreElasticWhereAnythingWithStiffnessActsOnThem) {
  EXPECT_FALSE(structural(make_test_cloth(3, 0.0, 0.0))[0].is_elastic);
  EXPECT_TRUE(structural(make_test_cloth(3, 10.0, 0.0))[0].is_elastic);
  NetworkBuilder bent;
  for (const double x : {0.0, 1.0, 2.0}) bent.add_particle({x, 0.0, 0.0}, 1.0);
  for (const Index i : {0, 1}) bent.add_spring(i, i + 1, 0.0, 1.0);
  EXPECT_FALSE(structural(bent.build())[0].is_elastic);
  bent.add_angle_bend(0, 1, 2, 1.0);
  EXPECT_TRUE(structural(bent.build())[0].is_elastic);
}

TEST(StretchComponents, AClothIsNoTree) {
  const auto found = structural(make_test_cloth(3, 0.0, 0.0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].is_tree);
  EXPECT_EQ(found[0].links.size(), 12u - 0u);
}

TEST(StretchComponents, TwoSpringsBetweenTheSameParticlesMakeNoLoop) {
  NetworkBuilder builder;
  for (Index i = 0; i < 3; ++i) builder.add_particle(Vector3(i, 0.0, 0.0), 1.0);
  for (Index i = 0; i < 2; ++i) builder.add_spring(i, i + 1, 0.0, 1.0);
  builder.add_spring(1, 2, 0.0, 1.5);
  const auto found = structural(builder.build());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_tree);
  EXPECT_EQ(found[0].links.size(), 3u);
}

TEST(StretchComponents, LinksAreSortedByTheirFirstPoint) {
  for (const StretchComponent& component : structural(make_random_network(100, 140, true))) {
    for (Index i = 0; i < component.free_count; ++i) {
      for (Index k = component.begin[i]; k < component.begin[i + 1]; ++k) {
        EXPECT_EQ(component.links[k].first, i);
        EXPECT_GT(component.links[k].second, i);
      }
    }
  }
}

}  // namespace
}  // namespace sprung
