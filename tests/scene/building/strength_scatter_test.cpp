// "strength_scatter": the break strains of bodies with a material.
#include "scene/building/strength_scatter.h"

#include "scene/building/scene_builder.h"
#include "scene/scene_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sprung {
namespace {

/// An entry of "bodies": a cloth whose structural springs break.
std::string cloth_body(const std::string& name, const std::string& keys) {
  return '"' + name + R"(": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [31, 31]}, )" + keys +
         R"(, "springs": {"structural": {"modulus": 100, "break": 0.25}}})";
}

/// A scene with these keys and this cloth.
std::string cloth(const std::string& keys, const std::string& name = "cloth", const std::string& body = R"("material": "cotton")") {
  return R"({"duration": 1, )" + keys + R"("bodies": {)" + cloth_body(name, body) + "}}";
}

/// Of each spring that breaks: its break strain, in units of the one in the scene.
std::vector<double> strengths(const std::string& text) {
  const BuiltScene built = build_scene(SceneFolder().read(text));
  std::vector<double> result;
  const Springs& springs = built.network.springs;
  for (std::size_t s = 0; s < springs.laws.size(); ++s) {
    if (springs.laws[s].breaks()) result.push_back((springs.laws[s].break_length / springs.rest_length[s] - 1.0) / 0.25);
  }
  return result;
}

// Lengths are products and sums of numbers near 1, divided by 0.25.
constexpr double kRounding = 1e-14;

TEST(StrengthScatter, IsUniformWithinItsBounds) {
  for (const double scatter : {0.02, 0.3}) {
    std::vector<double> values = strengths(cloth(scatter == 0.02 ? "" : R"("strength_scatter": 0.3, )"));
    ASSERT_EQ(values.size(), 2U * 31U * 30U) << "the structural springs";
    std::ranges::sort(values);
    EXPECT_GE(values.front(), 1.0 - scatter - kRounding);
    EXPECT_LE(values.back(), 1.0 + scatter + kRounding);
    // Kolmogorov and Smirnov: the largest distance from the uniform distribution is below 1.95 / sqrt(n) in 999 of 1000 samples.
    double distance = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double expected = (values[k] - 1.0 + scatter) / (2.0 * scatter);
      distance = std::max(distance, std::abs(expected - static_cast<double>(k) / static_cast<double>(values.size())));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(values.size())));
  }
}

TEST(StrengthScatter, IsAFunctionOfSeedAndName) {
  const std::vector<double> first = strengths(cloth(R"("seed": 3, )"));
  EXPECT_EQ(strengths(cloth(R"("seed": 3, )")), first);
  EXPECT_NE(strengths(cloth(R"("seed": 4, )")), first);
  EXPECT_NE(strengths(cloth(R"("seed": 3, )", "other")), first);
}

// A body that is added before the cloth takes the first numbers of springs and of random sequences, if these were of the scene.
TEST(StrengthScatter, IsNoFunctionOfOtherBodies) {
  const std::vector<double> alone = strengths(cloth(""));
  const std::vector<double> both = strengths(R"({"duration": 1, "bodies": {)" + cloth_body("a_cloth", R"("material": "denim")") +
                                             ", " + cloth_body("cloth", R"("material": "cotton")") + "}}");
  ASSERT_EQ(both.size(), 2 * alone.size());
  EXPECT_TRUE(std::equal(alone.begin(), alone.end(), both.begin() + static_cast<std::ptrdiff_t>(alone.size())));
}

TEST(StrengthScatter, IsOfBodiesWithAMaterialAlone) {
  for (const std::string& scene : {cloth("", "cloth", R"("density": 0.2)"), cloth(R"("strength_scatter": 0, )")}) {
    const std::vector<double> values = strengths(scene);
    ASSERT_FALSE(values.empty());
    for (const double strength : values) EXPECT_NEAR(strength, 1.0, kRounding);
  }
}

TEST(StrengthScatter, LeavesAttachmentsAsTheyAre) {
  const BuiltScene built = build_scene(SceneFolder().read(R"({"duration": 1, "strength_scatter": 0.5,
      "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 3, 0], "to": [1, 3, 0], "particles": 5}, "material": "hemp"}},
      "obstacles": {"post": {"shape": {"type": "sphere", "radius": 0.1}, "place": {"position": [0, 4, 0]}}},
      "attachments": [{"first": {"body": "rope", "indices": [0, 4]}, "second": {"obstacle": "post"}, "stiffness": 50, "break_force": 40}]})"));
  ASSERT_EQ(built.network.attachments.size(), 1U);
  EXPECT_EQ(built.network.attachments[0].break_force, 40.0);
}

TEST(StrengthScatter, UsesTheSeedWhereAStrengthScatters) {
  const auto uses = [](const std::string& text) { return uses_seed(SceneFolder().read(text)); };
  const std::string calm = R"("perturb": false, )";
  EXPECT_TRUE(uses(cloth(calm)));
  EXPECT_FALSE(uses(cloth(calm + R"("strength_scatter": 0, )")));
  EXPECT_FALSE(uses(cloth(calm, "cloth", R"("density": 0.2)")));
  EXPECT_TRUE(uses(cloth("", "cloth", R"("density": 0.2)"))) << "pushes off symmetry use it";
}

}  // namespace
}  // namespace sprung
