// Springs of OBJ groups, objects and materials with values of their own; cables, yield and break of a scene.
#include "network/model/spring_network.h"
#include "scene/building/scene_builder.h"
#include "scene/scene_text.h"
#include "simulation/simulator.h"

#include <gmock/gmock.h>

#include <cmath>

namespace sprung {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

/// Eight squares of 1 m along x: the first four are the group `soft`, the others `hard`.
std::string strip() {
  std::string text;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x <= 8; ++x) text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  }
  for (int x = 0; x < 8; ++x) {
    if (x % 4 == 0) text += x == 0 ? "g soft\n" : "g hard\n";
    for (const int corner : {x + 1, x + 2, x + 11, x + 10}) text += (corner == x + 1 ? "f " : " ") + std::to_string(corner);
    text += "\n";
  }
  return text;
}

Scene scene_of_strip(const SceneFolder& folder, const std::string& springs) {
  folder.write("strip.obj", strip());
  return folder.read(kPlainScene, {R"(bodies.banner.shape={"type":"mesh","file":"strip.obj"})", "bodies.banner.springs=" + springs,
                                   "gravity=[0,0,0]", "sleep=false",
                                   R"(bodies.banner.pins=[{"box":[[0,0,0],[0,1,0]]},
                                      {"box":[[8,0,0],[8,1,0]],"motion":{"keyframes":[{"time":0},{"time":1,"position":[1,0,0]}]}}])"});
}

// Both halves carry the same force, modulus * width * strain.
TEST(SpringGroups, HalvesOfAStripStretchInTheInverseRatioOfTheirModuli) {
  const SceneFolder folder;
  const Scene scene =
      scene_of_strip(folder, R"({"structural":{"modulus":100,"damping_time":0.02,"groups":{"soft":{},"hard":{"modulus":300}}}})");
  BuiltScene built = build_scene(scene, {});
  Simulator simulator(std::move(built.network), built.settings);
  while (simulator.time() < 10.0) simulator.step();
  const double soft = simulator.positions()(0, 4) - 4.0;
  const double hard = 1.0 - soft;
  // Waves of 63 m/s make the slowest mode omega = 25 / s, which decays with the rate damping_time omega^2 / 2 = 6 / s.
  EXPECT_NEAR(soft / hard, 3.0, 1e-9);
  EXPECT_NEAR(simulator.positions()(0, 2) - 2.0, soft / 2.0, 1e-9);
}

TEST(SpringGroups, TakeMissingValuesFromTheKind) {
  const SceneFolder folder;
  const Scene scene = scene_of_strip(folder, R"({"structural":{"stiffness":100,"damping":0.5,"yield":0.1,"groups":{
      "hard":{"stiffness":300,"break":0.5,"tension_only":true}}}})");
  const SpringNetwork network = build_scene(scene, {}).network;
  const Springs& springs = network.springs;
  int hard = 0;
  for (Index s = 0; s < springs.count(); ++s) {
    const bool is_hard = springs.first[s] % 9 >= 4 && springs.second[s] % 9 >= 4;
    hard += is_hard ? 1 : 0;
    EXPECT_EQ(springs.stiffness[s], is_hard ? 300.0 : 100.0) << springs.first[s] << " " << springs.second[s];
    EXPECT_EQ(springs.damping[s], 0.5);
    EXPECT_EQ(springs.laws[s].yield, 0.1);
    EXPECT_EQ(springs.laws[s].tension_only, is_hard);
    EXPECT_EQ(springs.laws[s].breaks(), is_hard);
    if (is_hard) {
      EXPECT_EQ(springs.laws[s].break_length, 1.5);
    }
  }
  EXPECT_EQ(hard, 4 + 4 + 5);
}

TEST(SpringGroups, AnUnknownGroupIsRefusedWithTheNearestName) {
  const SceneFolder folder;
  const Scene scene = scene_of_strip(folder, R"({"structural":{"stiffness":1,"groups":{"sofd":{"stiffness":2}}}})");
  EXPECT_THAT(problems_of([&] { (void)build_scene(scene, {}); }),
              ElementsAre(AllOf(Field(&Problem::key, "bodies.banner.springs.structural.groups"), Field(&Problem::value, "\"sofd\""),
                                Field(&Problem::rule, HasSubstr("must be a group, object or material of the mesh: hard, soft")),
                                Field(&Problem::remedy, HasSubstr("did you mean \"soft\"?")))));
}

TEST(SpringLaws, OfAClothHoldForItsKind) {
  const SceneFolder folder;
  const SpringNetwork network =
      build_scene(
          folder.read(kPlainScene, {R"(bodies.banner.springs={"structural":{"stiffness":10,"tension_only":true,"break":0.25},
                                                 "shear":{"stiffness":1,"yield":0.05},"bend":{"stiffness":1}})"}),
          {})
          .network;
  const Springs& springs = network.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    const SpringLaw law = springs.law(s);
    EXPECT_EQ(law.tension_only, springs.kind[s] == SpringKind::structural);
    EXPECT_EQ(law.yields(), springs.kind[s] == SpringKind::shear);
    EXPECT_EQ(law.breaks(), springs.kind[s] == SpringKind::structural);
    if (law.breaks()) {
      EXPECT_EQ(law.break_length, 1.25 * springs.rest_length[s]);
    }
  }
}

}  // namespace
}  // namespace sprung
