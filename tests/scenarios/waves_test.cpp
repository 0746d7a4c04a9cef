// A cloth with self-contact on a deforming surface.
#include "network/network_builder.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace sprung::testing {
namespace {

constexpr Index kSide = 10;  // vertices

/// A sheet of 1.2 m through which waves of 0.15 m run, four times a second.
SequenceGeometry waves() {
  constexpr int kFrames = 8;
  MeshSequence sequence{.triangles = Triangles(3, 2 * (kSide - 1) * (kSide - 1)), .frames = {}, .frame_rate = 30.0, .loop = true};
  Index t = 0;
  for (Index j = 0; j + 1 < kSide; ++j) {
    for (Index a = j * kSide; a + 1 < (j + 1) * kSide; ++a) {
      sequence.triangles.col(t++) << a, a + 1, a + kSide + 1;
      sequence.triangles.col(t++) << a, a + kSide + 1, a + kSide;
    }
  }
  for (int frame = 0; frame < kFrames; ++frame) {
    const double turn = 2.0 * std::numbers::pi * frame / kFrames;
    Points vertices(3, kSide * kSide);
    for (Index i = 0; i < kSide * kSide; ++i) {
      const double x = (static_cast<double>(i % kSide) / (kSide - 1) - 0.5) * 1.2;
      const double z = (static_cast<double>(i / kSide) / (kSide - 1) - 0.5) * 1.2;
      const double y = std::sin(5.0 * x + turn + 5.302969227577303) * std::cos(4.0 * z + 4.7599536504651) +
                       0.5 * std::sin(9.0 * z - turn + 2.6411895276177066);
      vertices.col(i) = Vector3(x, 0.15 * y, z);
    }
    sequence.frames.push_back(std::move(vertices));
  }
  return {.sequence = std::make_shared<const MeshSequence>(std::move(sequence)), .closed = false};
}

/// A rough and thick cloth falls 0.6 m onto the waves, with one step a frame.
BuiltScene cloth_on_waves() {
  const SpringMaterial limp{.value = 0.0};
  BodyShape cloth = make_cloth({.size = {0.6, 0.6}, .resolution = {6, 6}}, {limp, limp, limp});
  set_total_mass(cloth, 0.1);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  pose.translation().y() = 0.52;
  place(cloth, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("cloth", cloth, {.thickness = 0.02, .friction = 0.3, .static_friction = 0.3}, {.self = true});
  BuiltScene scene;
  scene.network = builder.build();
  scene.obstacles = {
      {.name = "waves", .geometry = waves(), .material = {.thickness = 0.02, .friction = 1.0, .static_friction = 1.0}}};
  scene.obstacles.front().rest_pose.translation().y() = -0.1;
  scene.settings.step = 1.0 / 60.0;
  scene.settings.stretch_limit = StretchLimitSettings{.max_stretch = 0.02, .iterations = 20};
  scene.frames = 121;
  return scene;
}

TEST(Waves, CrumpleAClothThatDoesNotCrossThem) {
  const ScenarioReport report = run_scenario(cloth_on_waves(), {}, Judge::obstacles_and_self);
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

}  // namespace
}  // namespace sprung::testing
