#include "scene/reading/scene_reader.h"

#include "base/as_nobody.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back(thing.name);
  return names;
}

TEST(SceneReader, EachSchemeHasItsName) {
  const auto scheme = [](const std::string& name) {
    return SceneFolder().read(kPlainScene, {"integrator={\"type\":\"" + name + "\"}"}).settings.integrator;
  };
  EXPECT_TRUE(std::holds_alternative<ExplicitEulerSettings>(scheme("explicit_euler")));
  EXPECT_TRUE(std::holds_alternative<SymplecticEulerSettings>(scheme("symplectic_euler")));
  EXPECT_TRUE(std::holds_alternative<VerletSettings>(scheme("verlet")));
  EXPECT_TRUE(std::holds_alternative<VelocityVerletSettings>(scheme("velocity_verlet")));
  EXPECT_TRUE(std::holds_alternative<RungeKutta4Settings>(scheme("rk4")));
  EXPECT_TRUE(std::holds_alternative<ImplicitEulerSettings>(scheme("implicit_euler")));
}

TEST(SceneReader, TimeAndSettingsArrive) {
  const SceneFolder folder;
  const Scene scene = folder.read(kFullScene);
  EXPECT_EQ(scene.file, folder.path() / "scene.json");
  EXPECT_EQ(scene.duration, 4.0);
  EXPECT_EQ(scene.frame_rate, 30.0);
  EXPECT_EQ(scene.step, 0.0003333333333333333);
  EXPECT_EQ(scene.settings.gravity, Vector3(0, -9.81, 0.5));
  EXPECT_EQ(scene.settings.air_drag, 0.25);
  EXPECT_EQ(scene.settings.air_surface.normal, 1.25);
  EXPECT_EQ(scene.settings.air_surface.tangential, 0.02);
  EXPECT_TRUE(scene.settings.air_surface.quadratic);
  EXPECT_EQ(scene.settings.wind.mean(0.0), Vector3(1, 0, -2));
  EXPECT_EQ(scene.settings.wind.mean(1.0), Vector3(3, 0, -1));
  ASSERT_TRUE(scene.settings.wind.gusts());
  EXPECT_EQ(scene.settings.wind.gusts()->speed, 3.0);
  EXPECT_EQ(scene.settings.wind.gusts()->length, 2.5);
  EXPECT_EQ(scene.settings.wind.gusts()->seed, 11U);
  const auto& verlet = std::get<VerletSettings>(scene.settings.integrator);
  EXPECT_EQ(verlet.damping, 0.001);
  EXPECT_EQ(verlet.damping_rate, 0.0);
  EXPECT_TRUE(verlet.start_at_rest);
  ASSERT_TRUE(scene.settings.stretch_limit);
  EXPECT_EQ(scene.settings.stretch_limit->max_stretch, 0.03);
  EXPECT_EQ(scene.settings.stretch_limit->max_compression, 0.9);
  EXPECT_THAT(scene.settings.stretch_limit->kinds, ElementsAre(SpringKind::structural, SpringKind::bend));
  EXPECT_EQ(scene.settings.stretch_limit->iterations, 16);
  EXPECT_EQ(scene.settings.stretch_limit->tolerance, 0.002);
  EXPECT_TRUE(scene.settings.stretch_limit->tethers);
  EXPECT_EQ(scene.settings.stretch_limit->solver, StretchLimitSettings::Solver::newton);
  EXPECT_EQ(scene.settings.contact.response, ContactSettings::Response::penalty);
  EXPECT_EQ(scene.settings.contact.stiffness, 1000.0);
  EXPECT_EQ(scene.settings.contact.damping, 0.5);
  EXPECT_EQ(scene.settings.contact.start, ContactSettings::Start::push_out);
  EXPECT_EQ(scene.settings.stability, StabilityCheck::warn);
  EXPECT_EQ(scene.mass_scaling, 0.125);
  EXPECT_FALSE(scene.settings.sleep);
  EXPECT_FALSE(scene.settings.perturb);
  EXPECT_EQ(scene.settings.seed, 7U);
  EXPECT_EQ(scene.strength_scatter, 0.25);
  EXPECT_TRUE(scene.settings.record_forces);
}

TEST(SceneReader, SchemaForEditorsIsAKnownKey) {
  EXPECT_EQ(SceneFolder().read(kFullScene, {"$schema=scene.schema.json"}).bodies.size(), 12U);
}

TEST(SceneReader, BodiesArriveInTheOrderOfTheFile) {
  const Scene scene = SceneFolder().read(kFullScene);
  EXPECT_THAT(names_of(scene.bodies),
              ElementsAre("zebra", "rope", "line", "jelly", "shirt", "scarf", "cable", "sponge", "ham", "horse", "cow", "balloon"));
  EXPECT_THAT(names_of(scene.obstacles),
              ElementsAre("bunny", "floor", "ball", "crate", "pill", "can", "hat", "egg", "heart", "lung"));
}

TEST(SceneReader, FieldsOfABodyArrive) {
  const Scene scene = SceneFolder().read(kFullScene);
  const BodyScene& body = scene.bodies[0];
  EXPECT_THAT(std::get<ClothShape>(body.shape).size, ElementsAre(1.0, 2.0));
  EXPECT_THAT(std::get<ClothShape>(body.shape).resolution, ElementsAre(64, 32));
  EXPECT_EQ(body.mass.kind, MassScene::Kind::body);
  EXPECT_EQ(body.mass.value, 0.2);
  EXPECT_EQ(body.springs.structural->value, 400.0);
  EXPECT_EQ(body.springs.structural->damping, 0.01);
  EXPECT_EQ(body.springs.shear->measure, SpringMaterial::Measure::modulus);
  EXPECT_EQ(body.springs.shear->value, 200.0);
  EXPECT_EQ(body.springs.bend->measure, SpringMaterial::Measure::stiffness);
  EXPECT_EQ(body.springs.bend->damping, 0.0);
  EXPECT_EQ(body.place.position, Vector3(0, 2, 0));
  EXPECT_EQ(body.place.rotation, Vector3(90, 0, 0));
  EXPECT_EQ(body.place.scale, 1.5);
  EXPECT_EQ(body.velocity, Vector3(1, 2, 3));
  EXPECT_EQ(body.material.thickness, 0.005);
  EXPECT_EQ(body.material.friction, 0.3);
  EXPECT_EQ(body.material.static_friction, 0.4);
  EXPECT_EQ(body.material.restitution, 0.1);
  EXPECT_FALSE(body.contact.others);
}

TEST(SceneReader, WhatFillsBodiesArrives) {
  const Scene scene = SceneFolder().read(kFullScene);
  const auto body = [&](const char* name) { return *std::ranges::find(scene.bodies, name, &BodyScene::name); };
  EXPECT_TRUE(body("ham").preserve_volume);
  EXPECT_EQ(std::get<LatticeFile>(body("horse").shape).cells, 24);
  EXPECT_TRUE(body("horse").normals);
  EXPECT_FALSE(body("horse").preserve_volume);
  EXPECT_EQ(std::get<LatticeFile>(body("cow").shape).cell_size, 0.1);
  EXPECT_EQ(body("balloon").pressure, 250.0);
  EXPECT_EQ(body("balloon").volume_factor, 1.5);
}

TEST(SceneReader, PinsArrive) {
  const Scene scene = SceneFolder().read(kFullScene);
  const std::vector<PinScene>& pins = scene.bodies[0].pins;
  ASSERT_EQ(pins.size(), 5U);
  EXPECT_THAT(std::get<CornersSelector>(pins[0].where).which, ElementsAre("min_min", "max_min"));
  EXPECT_FALSE(pins[0].motion.moves());
  EXPECT_EQ(std::get<NearestSelector>(pins[1].where).point, Vector3(0, 2, 0));
  EXPECT_EQ(std::get<BoxSelector>(pins[2].where).lower, Vector3(-1, 1, -1));
  EXPECT_EQ(std::get<BoxSelector>(pins[2].where).upper, Vector3(1, 3, 1));
  EXPECT_EQ(pins[2].motion.spin, Vector3(0, 90, 0));
  EXPECT_THAT(std::get<IndicesSelector>(pins[3].where).indices, ElementsAre(3, 5));
  EXPECT_EQ(pins[3].motion.interpolation, Interpolation::smooth);
  ASSERT_EQ(pins[3].motion.keyframes.size(), 2U);
  EXPECT_EQ(pins[3].motion.keyframes[1].position, Vector3(0, 1, 0));
  EXPECT_EQ(pins[3].follow, "");
  EXPECT_EQ(pins[3].from, 0.0);
  EXPECT_EQ(pins[3].until, std::numeric_limits<double>::infinity());
  EXPECT_EQ(std::get<SphereSelector>(pins[4].where).centre, Vector3(0, 1, 0));
  EXPECT_EQ(std::get<SphereSelector>(pins[4].where).radius, 0.25);
  EXPECT_EQ(pins[3].name, "");
  EXPECT_EQ(pins[4].name, "hand");
  EXPECT_EQ(pins[4].follow, "ball");
  EXPECT_EQ(pins[4].from, 0.5);
  EXPECT_EQ(pins[4].until, 2.0);
  EXPECT_EQ(std::get<GroupSelector>(scene.bodies[4].pins[0].where).name, "collar");
}

TEST(SceneReader, AttachmentsArrive) {
  const std::vector<AttachmentScene> attachments = SceneFolder().read(kFullScene).attachments;
  ASSERT_EQ(attachments.size(), 8U);
  EXPECT_EQ(attachments[0].first.body, "zebra");
  EXPECT_THAT(std::get<CornersSelector>(*attachments[0].first.where).which, ElementsAre("min_max"));
  EXPECT_EQ(attachments[0].second.body, "rope");
  EXPECT_EQ(std::get<NearestSelector>(*attachments[0].second.where).point, Vector3(0, 2, 0));
  EXPECT_EQ(attachments[0].stiffness, 500.0);
  EXPECT_EQ(attachments[0].damping, 0.5);
  EXPECT_EQ(attachments[0].rest_length, 0.0);
  EXPECT_EQ(attachments[0].break_force, 40.0);
  EXPECT_EQ(attachments[0].from, 0.5);
  EXPECT_EQ(attachments[0].until, 3.0);
  EXPECT_EQ(attachments[1].second.body, "jelly");
  EXPECT_FALSE(attachments[1].second.where);
  EXPECT_FALSE(attachments[1].stiffness);
  EXPECT_FALSE(attachments[1].rest_length);
  EXPECT_EQ(attachments[1].break_force, std::numeric_limits<double>::infinity());
  EXPECT_EQ(attachments[1].from, 0.0);
  EXPECT_EQ(attachments[1].until, std::numeric_limits<double>::infinity());
  EXPECT_EQ(attachments[2].second.body, "");
  EXPECT_EQ(attachments[2].second.obstacle, "heart");
  EXPECT_EQ(std::get<GroupSelector>(*attachments[2].first.where).name, "cuff");
}

TEST(SceneReader, PointMassesArrive) {
  const Scene scene = SceneFolder().read(kFullScene);
  const std::vector<PointMassScene>& masses = scene.bodies[0].point_masses;
  ASSERT_EQ(masses.size(), 5U);
  EXPECT_THAT(std::get<CornersSelector>(masses[0].where).which, ElementsAre("max_max"));
  EXPECT_EQ(masses[0].mass, 0.75);
  EXPECT_EQ(std::get<SphereSelector>(masses[4].where).radius, 4.0);
  EXPECT_EQ(std::get<GroupSelector>(scene.bodies[4].point_masses[0].where).name, "hem");
}

TEST(SceneReader, ShapesOfBodiesArrive) {
  const Scene scene = SceneFolder().read(kFullScene);
  const auto& rope = std::get<RopeShape>(scene.bodies[1].shape);
  EXPECT_THAT(rope.points, ElementsAre(Vector3(0, 0, 0), Vector3(1, 0, 0)));
  EXPECT_EQ(rope.particles, 5);
  EXPECT_EQ(rope.length, 1.25);
  EXPECT_EQ(scene.bodies[1].springs.structural->damping_ratio, 0.1);
  EXPECT_EQ(scene.bodies[1].springs.structural->damping, 0.0);
  EXPECT_EQ(scene.bodies[1].springs.bend_model, SpringMaterials::BendModel::angle);
  EXPECT_EQ(scene.bodies[0].springs.bend_model, SpringMaterials::BendModel::spring);
  EXPECT_EQ(scene.bodies[1].mass.kind, MassScene::Kind::particle);
  const auto& line = std::get<RopeShape>(scene.bodies[2].shape);
  EXPECT_THAT(line.points, ElementsAre(Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0)));
  EXPECT_EQ(line.particles, std::nullopt);
  EXPECT_EQ(line.length, std::nullopt);
  EXPECT_EQ(scene.bodies[2].mass.kind, MassScene::Kind::density);
  EXPECT_FALSE(scene.bodies[2].springs.structural);
  EXPECT_EQ(std::get<SolidShape>(scene.bodies[3].shape).size, Vector3(1, 2, 3));
  EXPECT_THAT(std::get<SolidShape>(scene.bodies[3].shape).resolution, ElementsAre(4, 5, 6));
  EXPECT_EQ(std::get<MeshFile>(scene.bodies[4].shape).file, "shirt.obj");
}

TEST(SceneReader, ObstaclesArrive) {
  const Scene scene = SceneFolder().read(kFullScene);
  const ObstacleScene& bunny = scene.obstacles[0];
  EXPECT_EQ(std::get<MeshFile>(bunny.shape).file, "bunny.obj");
  EXPECT_EQ(bunny.place.position, Vector3(0, 0, 1));
  EXPECT_EQ(bunny.place.scale, 0.6);
  EXPECT_EQ(bunny.material.friction, 0.4);
  EXPECT_EQ(bunny.material.static_friction, 0.4);
  EXPECT_EQ(bunny.material.restitution, 0.2);
  EXPECT_EQ(bunny.motion.keyframes[1].time, 1.0);
  EXPECT_EQ(bunny.motion.keyframes[1].rotation, Vector3(0, 90, 0));
  const auto& floor = std::get<HalfSpaceGeometry>(scene.obstacles[1].shape);
  EXPECT_EQ(floor.normal, Vector3(0, 1, 0));
  EXPECT_EQ(floor.offset, 0.25);
  EXPECT_EQ(std::get<SphereGeometry>(scene.obstacles[2].shape).radius, 0.5);
  EXPECT_EQ(std::get<BoxGeometry>(scene.obstacles[3].shape).size, Vector3(1, 2, 3));
  EXPECT_EQ(std::get<CapsuleGeometry>(scene.obstacles[4].shape).length, 2.0);
  EXPECT_EQ(std::get<CylinderGeometry>(scene.obstacles[5].shape).height, 3.0);
  EXPECT_EQ(std::get<ConeGeometry>(scene.obstacles[6].shape).radius, 0.3);
  EXPECT_EQ(std::get<EllipsoidGeometry>(scene.obstacles[7].shape).radii, Vector3(1, 2, 3));
}

TEST(SceneReader, SequencesDefaultToTheFrameRateOfTheScene) {
  const Scene scene = SceneFolder().read(kFullScene, {"frame_rate=50", "step=\"auto\""});
  const auto& heart = std::get<MeshFiles>(scene.obstacles[8].shape);
  EXPECT_THAT(std::get<std::vector<std::string>>(heart.files), ElementsAre("b.obj", "a.obj"));
  EXPECT_EQ(heart.frame_rate, 24.0);
  EXPECT_EQ(heart.start, -0.5);
  EXPECT_TRUE(heart.loop);
  const auto& lung = std::get<MeshFiles>(scene.obstacles[9].shape);
  EXPECT_EQ(std::get<std::string>(lung.files), "breath/lung.*.obj");
  EXPECT_EQ(lung.frame_rate, 50.0);
  EXPECT_EQ(lung.start, 0.0);
  EXPECT_FALSE(lung.loop);
}

TEST(SceneReader, DefaultsAreTheDocumentedOnes) {
  const Scene scene = SceneFolder().read(R"({"duration": 2, "bodies": {"rope": {
      "shape": {"type": "rope", "points": [[0, 0, 0], [1, 0, 0]]}, "mass": 1}}})");
  EXPECT_EQ(scene.frame_rate, 30.0);
  EXPECT_EQ(scene.step, std::nullopt);
  EXPECT_EQ(scene.mass_scaling, kMassScaling);
  EXPECT_EQ(scene.settings.gravity, Vector3(0, -9.81, 0));
  EXPECT_EQ(scene.settings.air_drag, 0.0);
  EXPECT_TRUE(scene.settings.air_surface.is_zero());
  EXPECT_TRUE(scene.settings.wind.is_calm());
  EXPECT_TRUE(scene.air_of_materials);
  EXPECT_TRUE(std::holds_alternative<VerletSettings>(scene.settings.integrator));
  EXPECT_FALSE(scene.settings.stretch_limit);
  EXPECT_EQ(scene.settings.contact.response, ContactSettings::Response::projection);
  EXPECT_EQ(scene.settings.contact.start, ContactSettings::Start::refuse);
  EXPECT_EQ(scene.settings.stability, StabilityCheck::refuse);
  EXPECT_TRUE(scene.settings.sleep);
  EXPECT_TRUE(scene.settings.perturb);
  EXPECT_EQ(scene.settings.seed, 0U);
  EXPECT_EQ(scene.strength_scatter, 0.02);
  EXPECT_FALSE(scene.settings.record_forces);
  EXPECT_EQ(scene.bodies[0].place.scale, 1.0);
  EXPECT_EQ(scene.bodies[0].velocity, Vector3(0, 0, 0));
  EXPECT_FALSE(scene.bodies[0].contact.self);
  EXPECT_TRUE(scene.bodies[0].contact.others);
  EXPECT_TRUE(scene.obstacles.empty());
}

TEST(SceneReader, ContactResponseDefaultsToProjection) {
  const Scene scene = SceneFolder().read(kPlainScene, {"contact={\"start\":\"push_out\"}"});
  EXPECT_EQ(scene.settings.contact.response, ContactSettings::Response::projection);
  EXPECT_EQ(scene.settings.contact.start, ContactSettings::Start::push_out);
}

TEST(SceneReader, ResolvedSceneReadsBackAsItself) {
  const SceneFolder folder;
  for (const char* text : {kPlainScene, kFullScene}) {
    const std::string resolved = folder.read(text, {"gravity=[0,-1,0]"}).resolved;
    EXPECT_THAT(resolved, HasSubstr("\"restitution\": 0.0"));
    EXPECT_EQ(folder.read(resolved).settings.gravity, Vector3(0, -1, 0));
    EXPECT_EQ(folder.read(resolved).resolved, resolved);
  }
}

TEST(SceneReader, WholeNumbersMayBeWrittenWithAPoint) {
  const Scene scene = SceneFolder().read(kPlainScene, {"bodies.banner.shape.resolution=[64.0,6.4e1]"});
  EXPECT_THAT(std::get<ClothShape>(scene.bodies[0].shape).resolution, ElementsAre(64, 64));
}

TEST(SceneReader, EncodingsAndLineEndsDoNotMatter) {
  const SceneFolder folder;
  const std::string plain = kPlainScene;
  std::string utf16 = "\xFF\xFE";
  for (const char letter : plain) (utf16 += letter) += '\0';
  std::string returns = plain;
  std::ranges::replace(returns, '\n', '\r');
  for (const std::string& text : {"\xEF\xBB\xBF" + plain, utf16, utf16.substr(2), returns}) {
    EXPECT_EQ(folder.read(text).resolved, folder.read(plain).resolved);
  }
}

TEST(SceneReader, AMissingFileOrAFolderIsAFileError) {
  const SceneFolder folder;
  EXPECT_THAT([&] { (void)read_scene(folder.path() / "none.json"); },
              testing::ThrowsMessage<FileError>(testing::AllOf(HasSubstr("none.json"), HasSubstr("No such file"))));
  folder.write("nine.json", kPlainScene);
  folder.write("nine.obj", "");
  EXPECT_THAT([&] { (void)read_scene(folder.path() / "nin.json"); },
              testing::ThrowsMessage<FileError>(HasSubstr("did you mean \"" + (folder.path() / "nine.json").string() + "\"?")));
  EXPECT_THAT([&] { (void)read_scene(folder.path()); }, testing::ThrowsMessage<FileError>(HasSubstr("Is a directory")));
}

TEST(SceneReader, AFileWithoutReadPermissionIsAFileError) {
  const SceneFolder folder;
  const std::filesystem::path file = folder.write("secret.json", kPlainScene);
  std::filesystem::permissions(file, std::filesystem::perms::none);
  const test::AsNobody nobody;
  EXPECT_THAT([&] { (void)read_scene(file); },
              testing::ThrowsMessage<FileError>(testing::AllOf(HasSubstr("secret.json"), HasSubstr("Permission denied"))));
}

TEST(SceneReader, OverridesReplaceAddAppendAndRemove) {
  const Scene scene = SceneFolder().read(
      kPlainScene, {"bodies.banner.shape.resolution=[128, 64]", "bodies.banner.pins[0].which[0]=max_max", "stability=warn",
                    "bodies.banner.pins[1].nearest=[0,1,0]", "air.wind=[1,0,0]", "bodies.banner.mass=null",
                    "bodies.banner.density=0.3", "bodies.banner.place.position=[0, 1e-3, 0]"});
  EXPECT_THAT(std::get<ClothShape>(scene.bodies[0].shape).resolution, ElementsAre(128, 64));
  EXPECT_THAT(std::get<CornersSelector>(scene.bodies[0].pins[0].where).which, ElementsAre("max_max"));
  EXPECT_EQ(scene.settings.stability, StabilityCheck::warn);
  EXPECT_EQ(std::get<NearestSelector>(scene.bodies[0].pins[1].where).point, Vector3(0, 1, 0));
  EXPECT_EQ(scene.settings.wind.velocity(Vector3(2, 3, 4), 5.0), Vector3(1, 0, 0));
  EXPECT_EQ(scene.bodies[0].mass.kind, MassScene::Kind::density);
  EXPECT_EQ(scene.bodies[0].place.position, Vector3(0, 1e-3, 0));
}

TEST(SceneReader, OverridesAcceptCommonNumberFormats) {
  for (const char* text : {".5", "+0.5", "0.5", "00.50", "5e-1", "+.5e0"}) {
    const Scene scene = SceneFolder().read(kPlainScene, {std::string("bodies.banner.mass=") + text});
    EXPECT_EQ(scene.bodies[0].mass.value, 0.5) << text;
  }
}

TEST(SceneReader, OverridesAddABodyThatBeginsWithItsShape) {
  const Scene scene =
      SceneFolder().read(kPlainScene, {R"(bodies.line.shape={"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 5})",
                                       "bodies.line.mass=2.", "bodies.line.springs.structural.stiffness=10"});
  EXPECT_EQ(scene.bodies.size(), 2U);
}

}  // namespace
}  // namespace sprung
