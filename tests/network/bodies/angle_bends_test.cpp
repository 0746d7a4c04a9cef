#include "network/damping_ratio.h"
#include "network/network_builder.h"
#include "network/network_helpers.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

using namespace testing;
using ::testing::Each;
using ::testing::ElementsAre;

SpringMaterials angles(const SpringMaterial& material) {
  return {.bend = material, .bend_model = SpringMaterials::BendModel::angle};
}

TEST(AngleBends, OfARopeHaveAStiffnessByTheirLengths) {
  const RopeShape bent{{Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(2, 1, 0), Vector3(2, 1, 3)}, std::nullopt, std::nullopt};
  const AngleBends bends = make_rope(bent, angles(modular(6.0))).angle_bends;
  EXPECT_THAT(bends.before, ElementsAre(0, 1));
  EXPECT_THAT(bends.middle, ElementsAre(1, 2));
  EXPECT_THAT(bends.after, ElementsAre(2, 3));
  EXPECT_THAT(bends.length_before, ElementsAre(2.0, 1.0));
  EXPECT_THAT(bends.length_after, ElementsAre(1.0, 3.0));
  EXPECT_THAT(bends.stiffness, ElementsAre(6.0 / 1.5, 6.0 / 2.0));  // EI / l
  EXPECT_THAT(make_rope(bent, angles(stiff(6.0))).angle_bends.stiffness, Each(6.0));
  EXPECT_EQ(make_rope(bent, angles(stiff(6.0))).springs.count(), 0);
}

TEST(AngleBends, OfAClothLieAlongItsRowsAndColumns) {
  const BodyShape cloth = make_cloth({.size = {4.0, 2.0}, .resolution = {5, 3}}, angles(modular(8.0)));
  const AngleBends& bends = cloth.angle_bends;
  ASSERT_EQ(bends.count(), 3 * 3 + 5);
  EXPECT_EQ(count(cloth, SpringKind::bend), 0);
  for (Index e = 0; e < bends.count(); ++e) {
    const Index stride = e < 9 ? 1 : 5;
    EXPECT_EQ(bends.middle[e] - bends.before[e], stride);
    EXPECT_EQ(bends.after[e] - bends.middle[e], stride);
    // D w / l in cells of 1 m, on a border half of it.
    const bool on_border = e < 9 ? e / 3 != 1 : bends.middle[e] == 5 || bends.middle[e] == 9;
    EXPECT_EQ(bends.stiffness[e], on_border ? 4.0 : 8.0) << e;
  }
}

TEST(AngleBends, DampingRatioRefersToBendingWithUniformCurvature) {
  // EI L against the integral of density (s^2 / 2)^2: omega^2 = 20 EI / (density L^4) about an end. The error of the sum over n
  // cells is some 1 / n^2.
  BodyShape shape = make_rope({{Vector3::Zero(), Vector3(2, 0, 0)}, 101, std::nullopt},
                              angles({3.0, SpringMaterial::Measure::modulus, 0.0, 0.2}));
  set_density(shape, 0.5);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin(0);
  const SpringNetwork network = builder.build();
  const double omega = bending_frequency(network, network.bodies[0]);
  const double expected = std::sqrt(20.0 * 3.0 / 0.5) / 4.0;
  EXPECT_NEAR(omega, expected, 0.01 * expected);  // the ends have no element: 1 % of EI L is missing
  for (Index e = 0; e < network.angle_bends.count(); ++e) {
    EXPECT_DOUBLE_EQ(network.angle_bends.damping[e], 2.0 * 0.2 * network.angle_bends.stiffness[e] / omega);
  }
}

TEST(AngleBends, CanBeAddedOneByOneToABody) {
  NetworkBuilder builder;
  builder.begin_body("one");
  builder.add_particle(Vector3::Zero(), 1.0);
  builder.begin_body("two");
  const Index a = builder.add_particle(Vector3(0, 0, 0), 1.0);
  const Index b = builder.add_particle(Vector3(3, 0, 0), 1.0);
  const Index c = builder.add_particle(Vector3(3, 4, 0), 1.0);
  builder.add_angle_bend(a, b, c, 7.0, 0.5);
  const SpringNetwork network = builder.build();
  EXPECT_EQ(network.bodies[0].angle_bend_count, 0);
  EXPECT_EQ(network.bodies[1].angle_bend_count, 1);
  EXPECT_THAT(network.angle_bends.before, ElementsAre(1));
  EXPECT_THAT(network.angle_bends.length_after, ElementsAre(4.0));
  EXPECT_THAT(network.angle_bends.damping, ElementsAre(0.5));
}

TEST(AngleBends, InvalidOnesAreRefused) {
  const auto refused = [](const std::array<Index, 3>& ends, double stiffness, double damping) {
    NetworkBuilder builder;
    for (const double x : {0.0, 1.0, 2.0, 2.0}) builder.add_particle(Vector3(x, 0, 0), 1.0);
    builder.begin_body("other");
    builder.add_particle(Vector3(5, 0, 0), 1.0);
    builder.add_angle_bend(ends[0], ends[1], ends[2], stiffness, damping);
    return problem_keys([&] { return builder.build(); });
  };
  EXPECT_THAT(refused({0, 1, 2}, 1.0, 1.0), ElementsAre());
  EXPECT_THAT(refused({0, 1, 4}, 1.0, 0.0), ElementsAre("angle_bends[0]"));
  EXPECT_THAT(refused({0, 1, 9}, 1.0, 0.0), ElementsAre("angle_bends[0]"));
  EXPECT_THAT(refused({0, 1, 0}, 1.0, 0.0), ElementsAre("bodies.network.angle_bends[0]"));
  EXPECT_THAT(refused({1, 2, 3}, 1.0, 0.0), ElementsAre("bodies.network.angle_bends.length[0]"));
  EXPECT_THAT(refused({0, 1, 2}, -1.0, 0.0), ElementsAre("bodies.network.angle_bends.stiffness[0]"));
  EXPECT_THAT(refused({0, 1, 2}, 1.0, -1.0), ElementsAre("bodies.network.angle_bends.damping[0]"));
}

TEST(AngleBends, AreRefusedForSolidsAndCoincidingPoints) {
  const SpringMaterials materials = angles(stiff(1.0));
  EXPECT_THAT(problem_keys([&] { return make_solid({}, materials); }), ElementsAre("springs.bend.model"));
  const RopeShape folded{{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 0, 0)}, std::nullopt, std::nullopt};
  EXPECT_THAT(problem_keys([&] { return make_rope(folded, materials); }), ElementsAre("points[2]"));
}

}  // namespace
}  // namespace sprung
