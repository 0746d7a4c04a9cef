#include "scene/building/scene_builder.h"

#include "geometry/mesh/polygon_mesh.h"
#include "network/model/pin.h"
#include "network/model/spring_network.h"
#include "scene/building/mesh_finder.h"
#include "scene/scene_text.h"
#include "simulation/simulator.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::Field;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

BuiltScene build(const SceneFolder& folder, const std::vector<std::string>& changes,
                 const std::vector<std::filesystem::path>& mesh_paths = {}) {
  return build_scene(folder.read(kPlainScene, changes), mesh_paths);
}

std::vector<Problem> build_problems(const std::vector<std::string>& changes) {
  const SceneFolder folder;
  return problems_of([&] { (void)build(folder, changes); });
}

std::vector<Index> pinned(const SpringNetwork& network) {
  std::vector<Index> particles;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_fixed(i)) particles.push_back(i);
  }
  return particles;
}

auto problem(const std::string& key, const std::string& rule) {
  return AllOf(Field(&Problem::file, EndsWith("scene.json")), Field(&Problem::key, key), Field(&Problem::rule, HasSubstr(rule)));
}

TEST(SceneBuilder, PlainSceneIsBuilt) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"duration=2", "frame_rate=24"});
  EXPECT_EQ(built.frames, 49);
  EXPECT_EQ(built.network.particle_count(), 9);
  EXPECT_EQ(built.network.bodies[0].name, "banner");
  EXPECT_NEAR(built.network.masses.sum(), 0.2, 1e-15);  // nine roundings of 0.2 / 9
  EXPECT_THAT(pinned(built.network), ElementsAre(0));
  ASSERT_EQ(built.obstacles.size(), 1U);
  EXPECT_EQ(built.obstacles[0].name, "floor");
  EXPECT_EQ(std::get<HalfSpaceGeometry>(built.obstacles[0].geometry).offset, -5.0);
  EXPECT_THAT(built.warnings, IsEmpty());
}

// Except for the last pin, because it depends on the invalid place of its body.
TEST(SceneBuilder, ProblemsBeyondTheTextAreReportedWithThoseOfTheText) {
  const SceneFolder folder;
  folder.write("broken.obj", "v 0 0\n");
  const std::string text = R"({"duration": 1, "step": "atuo", "bodies": {
      "heavy": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "mass": 1, "density": 1, "pins": [{"indices": [9]}]},
      "torn": {"shape": {"type": "mesh", "file": "broken.obj"}, "mass": 1, "springs": {"structural": {"stifness": 1}}},
      "narrow": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3]}, "mass": 1, "pins": [{"indices": [9]}]},
      "astray": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "mass": 1, "place": {"position": "up"},
                 "pins": [{"box": [[7, 7, 7], [8, 8, 8]]}]}},
      "obstacles": {"floor": {"shape": {"type": "mesh", "file": "flor.obj"}, "friction": -1},
                    "ball": {"shape": {"type": "mesh", "fiel": "ball.obj"}}}})";
  TextProblems known;
  const Scene scene = read_scene_text(text, folder.write("scene.json", text), {}, known);
  const std::size_t of_text = known.all.size();
  std::vector<Problem> all = problems_of([&] { (void)build_scene(scene, {}, known); });
  EXPECT_TRUE(std::equal(known.all.begin(), known.all.end(), all.begin()));
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(of_text));
  EXPECT_THAT(all, ElementsAre(problem("bodies.heavy.pins[0].indices[0]", "the body has 9 particles"),
                               AllOf(Field(&Problem::file, EndsWith("broken.obj")), Field(&Problem::key, "line 1")),
                               problem("obstacles.floor.shape.file", "no such file")));
}

TEST(SceneBuilder, BuiltSceneRuns) {
  const SceneFolder folder;
  BuiltScene built = build(folder, {});
  Simulator simulator(std::move(built.network), built.settings, std::move(built.obstacles));
  for (int step = 0; step < built.settings.steps_per_frame; ++step) simulator.step();
  // One frame of 1/30 s, up to the rounding of step * dt.
  EXPECT_NEAR(simulator.time(), 1.0 / 30.0, 1e-15);
}

TEST(SceneBuilder, ContactSettingsOfABodyArrive) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"bodies.banner.self_contact=true", "bodies.banner.body_contact=false"});
  EXPECT_TRUE(built.network.bodies[0].contact.self);
  EXPECT_FALSE(built.network.bodies[0].contact.others);
}

TEST(SceneBuilder, MassIsGivenPerBodyPerParticleOrByDensity) {
  const SceneFolder folder;
  const auto total = [&](const std::string& mass) {
    return build(folder, {"bodies.banner.mass=null", mass, "bodies.banner.shape.size=[2,3]"}).network.masses.sum();
  };
  EXPECT_NEAR(total("bodies.banner.mass=5"), 5.0, 1e-14);
  EXPECT_NEAR(total("bodies.banner.particle_mass=5"), 45.0, 1e-13);
  EXPECT_NEAR(total("bodies.banner.density=5"), 30.0, 1e-13);
}

TEST(SceneBuilder, ScaleIsAppliedBeforeSpringsAndDensity) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"bodies.banner.place.scale=4", "bodies.banner.mass=null", "bodies.banner.density=1"});
  EXPECT_NEAR(built.network.masses.sum(), 16.0, 1e-13);
  for (const double rest : built.network.springs.rest_length) EXPECT_EQ(rest, 2.0);  // 4 m in two springs: exact
  EXPECT_EQ(built.network.positions.col(0), Vector3(-2, -2, 0));
}

TEST(SceneBuilder, PlaceRotatesThenMovesAndVelocityIsAdded) {
  const SceneFolder folder;
  const BuiltScene built = build(
      folder, {"bodies.banner.place.rotation=[90,0,0]", "bodies.banner.place.position=[1,2,3]", "bodies.banner.velocity=[0,0,7]"});
  // (-0.5, -0.5, 0) turned by 90 degrees about x is (-0.5, 0, -0.5); multiples of 90 degrees are exact.
  EXPECT_EQ(built.network.positions.col(0), Vector3(0.5, 2.0, 2.5));
  EXPECT_EQ(built.network.velocities.col(8), Vector3(0, 0, 7));
}

TEST(SceneBuilder, PinsFindTheirParticles) {
  const SceneFolder folder;
  const auto pins = [&](const std::string& text) {
    return pinned(build(folder, {"bodies.banner.place.position=[0,2,0]", "bodies.banner.pins=" + text}).network);
  };
  EXPECT_THAT(pins(R"([{"at": "corner", "which": ["max_max", "min_max"]}])"), ElementsAre(6, 8));
  EXPECT_THAT(pins(R"([{"indices": [4, 1]}])"), ElementsAre(1, 4));
  EXPECT_THAT(pins(R"([{"nearest": [10, 2.1, 0]}])"), ElementsAre(5));
  EXPECT_THAT(pins(R"([{"nearest": [0.25, 2, 0]}])"), ElementsAre(4)) << "the first of two equally near particles";
  EXPECT_THAT(pins(R"([{"box": [[-1, 2.5, 0], [1, 2.5, 0]]}])"), ElementsAre(6, 7, 8)) << "a box may be flat";
  EXPECT_THAT(pins(R"([{"box": [[-1, 2, -1], [1, 3, 1]]}, {"indices": [3, 0]}])"), ElementsAre(0, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(pins(R"([{"sphere": [[0, 2, 0], 0.5]}])"), ElementsAre(1, 3, 4, 5, 7)) << "its surface belongs to it";
  EXPECT_THAT(pins(R"([{"sphere": [[0.5, 2.5, 0], 0.49]}])"), ElementsAre(8));
  EXPECT_THAT(pins("[]"), IsEmpty());
}

TEST(SceneBuilder, AFlatBoxContainsARowDespiteRoundingOfItsPosition) {
  const SceneFolder folder;
  // 0.35 above each height, in decimals: the height of the placed row differs from it in the last bits.
  for (const auto& [height, top] : {std::pair{"0.1", "0.45"}, {"17.3", "17.65"}, {"123.4", "123.75"}}) {
    const std::string y = std::string(",") + top + ",";
    const std::string box = "[[-9" + y + "-9],[9" + y + "9]]";
    const BuiltScene built = build(folder, {"bodies.banner.place.scale=0.7", "bodies.banner.pins=[{\"box\":" + box + "}]",
                                            std::string("bodies.banner.place.position=[0,") + height + ",0]"});
    EXPECT_THAT(pinned(built.network), ElementsAre(6, 7, 8)) << height;
  }
}

TEST(SceneBuilder, AParticleOfSeveralRestingPinsBelongsToTheFirstAndMovingPinsTurnAboutThePositionOfTheBody) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"bodies.banner.place.position=[0,2,0]",
                                          R"(bodies.banner.pins=[{"indices":[1,0]},{"indices":[8],"motion":{"spin":[0,90,0]}},
                                             {"indices":[1,0]},{"indices":[1,2]}])"});
  const std::vector<Pin>& pins = built.network.pins;
  ASSERT_EQ(pins.size(), 3U);
  EXPECT_THAT(pins[0].particles, ElementsAre(0, 1));
  EXPECT_THAT(pins[1].particles, ElementsAre(8));
  EXPECT_EQ(pins[1].origin, Vector3(0, 2, 0));
  EXPECT_EQ(pins[1].motion.spin, Vector3(0, 90, 0));
  EXPECT_THAT(pins[2].particles, ElementsAre(2));
  EXPECT_EQ(pins[0].name, "banner.pins[0]");
  EXPECT_EQ(pins[1].name, "banner.pins[1]");
  EXPECT_EQ(pins[2].name, "banner.pins[3]");
}

// A quad per group, object or material; welded, its corners are particles of both.
constexpr const char* kGarment =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\n"
    "g body\nusemtl wool\nf 1 2 3 4\no Sleeve\ng left cuff\nusemtl silk\nf 5 6 7 8\n";

TEST(SceneBuilder, PinsFindTheGroupsObjectsAndMaterialsOfAMesh) {
  const SceneFolder folder;
  folder.write("garment.obj", kGarment);
  const auto pins = [&](const std::string& group, const std::string& weld) {
    return pinned(build(folder, {"bodies.banner.shape={\"type\":\"mesh\",\"file\":\"garment.obj\"" + weld + "}",
                                 "bodies.banner.pins=[{\"group\":\"" + group + "\"}]"})
                      .network);
  };
  for (const char* group : {"cuff", "left", "Sleeve", "silk"}) {
    EXPECT_THAT(pins(group, ""), ElementsAre(4, 5, 6, 7)) << group;
    EXPECT_THAT(pins(group, ",\"weld\":1e-6"), ElementsAre(1, 2, 4, 5)) << group;
  }
  EXPECT_THAT(pins("wool", ",\"weld\":1e-6"), ElementsAre(0, 1, 2, 3));
}

TEST(SceneBuilder, UnknownGroupsAreProblemsThatListTheKnownOnes) {
  const SceneFolder folder;
  folder.write("garment.obj", kGarment);
  folder.write("plain.obj", kTetrahedron);
  const auto problems = [&](const std::string& mesh) {
    return problems_of([&] {
      (void)build(folder,
                  {"bodies.banner.shape={\"type\":\"mesh\",\"file\":\"" + mesh + "\"}", "bodies.banner.pins=[{\"group\":\"cufs\"}]",
                   "bodies.banner.point_masses=[{\"group\":\"hem\",\"mass\":1}]"});
    });
  };
  const std::string rule = "must be a group, object or material of the mesh: Sleeve, body, cuff, left, silk, wool";
  EXPECT_THAT(problems("garment.obj"),
              ElementsAre(AllOf(problem("bodies.banner.point_masses[0].group", rule), Field(&Problem::remedy, "")),
                          AllOf(problem("bodies.banner.pins[0].group", rule), Field(&Problem::value, "\"cufs\""),
                                Field(&Problem::remedy, "did you mean \"cuff\"?"))));
  EXPECT_THAT(problems("plain.obj"), ElementsAre(problem("bodies.banner.point_masses[0].group", "no group, object or material"),
                                                 problem("bodies.banner.pins[0].group", "no group, object or material")));
}

TEST(SceneBuilder, PointMassesAreAddedToEachSelectedParticle) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"bodies.banner.mass=0.9",
                                          R"(bodies.banner.point_masses=[{"indices":[8,1],"mass":0.75},
                                             {"at":"corner","which":["max_max"],"mass":0.25}])"});
  for (Index i = 0; i < 9; ++i) {
    const double added = i == 8 ? 1.0 : (i == 1 ? 0.75 : 0.0);
    EXPECT_NEAR(built.network.masses[i], 0.1 + added, 1e-15) << i;
  }
}

// The weights of both ends hang on the spring; after 100 times its decay time 2 m / c it is at rest.
TEST(SceneBuilder, APointMassStretchesASpringByItsWeightOverTheStiffness) {
  const SceneFolder folder;
  const std::string text = R"({"duration": 1, "frame_rate": 100, "bodies": {"line": {
      "shape": {"type": "rope", "from": [0, 0, 0], "to": [0, -1, 0], "particles": 2}, "particle_mass": 0.25,
      "springs": {"structural": {"stiffness": 400, "damping": 40}}, "pins": [{"at": "corner", "which": ["from"]}],
      "point_masses": [{"at": "corner", "which": ["to"], "mass": 0.75}]}}})";
  BuiltScene built = build_scene(folder.read(text));
  Simulator simulator(std::move(built.network), built.settings);
  while (simulator.time() < 5.0) simulator.step();
  EXPECT_NEAR(simulator.positions()(1, 1), -1.0 - (0.25 + 0.75) * 9.81 / 400.0, 1e-9);
}

TEST(SceneBuilder, PinsKnowTheirTimesAndTheNumberOfTheObstacleThatTheyFollow) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {R"(obstacles.hand={"shape":{"type":"sphere","radius":0.1},"place":{"position":[9,9,9]}})",
                                          R"(bodies.banner.pins=[{"indices":[0],"follow":"hand","from":0.25,"until":0.5},
                                             {"indices":[0,1],"from":0.5},{"indices":[2],"follow":"hand","until":0.5}])"});
  const std::vector<Pin>& pins = built.network.pins;
  ASSERT_EQ(pins.size(), 3U);
  EXPECT_EQ(pins[0].obstacle, 1);
  EXPECT_EQ(pins[0].from, 0.25);
  EXPECT_EQ(pins[0].name, "banner.pins[0]");
  EXPECT_EQ(pins[1].obstacle, kNone);
  EXPECT_THAT(pins[1].particles, ElementsAre(0, 1));
  EXPECT_EQ(pins[1].name, "banner.pins[1]");
  EXPECT_THAT(held_particles(built.network, 2), ElementsAre(2)) << "the only one that begins at time 0";
  EXPECT_EQ(pins[2].obstacle, 1);
  EXPECT_EQ(pins[2].until, 0.5);
  EXPECT_EQ(pins[2].name, "banner.pins[2]");
}

constexpr const char* kLine =
    R"(bodies.line={"shape":{"type":"rope","from":[3,0,0],"to":[4,0,0],"particles":3},"mass":1,"springs":{"structural":{"stiffness":100}}})";

TEST(SceneBuilder, AttachmentsKnowTheirEnds) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {kLine,
                                          R"(attachments=[
      {"first":{"body":"line","at":"corner","which":["from","to"]},"second":{"body":"banner","box":[[-1,-1,-1],[1,0,1]]},"stiffness":50,
       "damping":2,"rest_length":0.5,"break_force":7,"from":0.25,"until":0.5},
      {"first":{"body":"line","indices":[1]},"second":{"body":"banner"}},
      {"first":{"body":"banner","nearest":[9,9,0]},"second":{"obstacle":"floor"}}])"});
  const std::vector<Attachment>& attachments = built.network.attachments;
  ASSERT_EQ(attachments.size(), 3U);
  EXPECT_EQ(attachments[0].name, "attachments[0]");
  EXPECT_THAT(attachments[0].particles, ElementsAre(9, 11));
  EXPECT_THAT(std::get<ParticleEnds>(attachments[0].second).particles, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(attachments[0].stiffness, 50.0);
  EXPECT_EQ(attachments[0].damping, 2.0);
  EXPECT_EQ(attachments[0].rest_length, 0.5);
  EXPECT_EQ(attachments[0].break_force, 7.0);
  EXPECT_EQ(attachments[0].from, 0.25);
  EXPECT_EQ(attachments[0].until, 0.5);
  EXPECT_THAT(attachments[1].particles, ElementsAre(10));
  EXPECT_EQ(std::get<SurfaceEnd>(attachments[1].second).body, 0);
  EXPECT_TRUE(attachments[1].is_rigid());
  EXPECT_THAT(attachments[2].particles, ElementsAre(8));
  EXPECT_EQ(std::get<ObstacleEnd>(attachments[2].second).obstacle, 0);
}

TEST(SceneBuilder, AttachmentsWithoutParticlesOrWithOneAtBothEndsAreProblems) {
  EXPECT_THAT(build_problems({R"(attachments=[
      {"first":{"body":"banner","box":[[7,7,7],[8,8,8]]},"second":{"obstacle":"floor"}},
      {"first":{"body":"banner","indices":[0]},"second":{"body":"banner","indices":[9]}},
      {"first":{"body":"banner","indices":[0,4]},"second":{"body":"banner","indices":[4,5]}}])"}),
              ElementsAre(problem("attachments[0].first.box", "contains no particle of the body"),
                          problem("attachments[1].second.indices[0]", "the body has 9 particles"),
                          problem("attachments[2]", "has the same particle at both ends")));
}

TEST(SceneBuilder, PinsOfLaterBodiesCountFromTheirOwnFirstParticle) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {R"(bodies.rope={"shape":{"type":"rope","from":[0,5,0],"to":[1,5,0],"particles":4},
                                             "mass":1,"pins":[{"at":"corner","which":["to"]}]})"});
  EXPECT_THAT(pinned(built.network), ElementsAre(0, 12));
}

TEST(SceneBuilder, InvalidPinsAreProblems) {
  EXPECT_THAT(build_problems({"bodies.banner.pins=[{\"indices\":[0,9]}]"}),
              ElementsAre(problem("bodies.banner.pins[0].indices[1]", "the body has 9 particles")));
  EXPECT_THAT(build_problems({"bodies.banner.pins=[{\"box\":[[5,5,5],[6,6,6]]}]"}),
              ElementsAre(problem("bodies.banner.pins[0].box", "contains no particle")));
  EXPECT_THAT(build_problems({"bodies.banner.pins=[{\"indices\":[0]},{\"indices\":[0],\"motion\":{\"spin\":[0,1,0]}}]"}),
              ElementsAre(problem("bodies.banner.pins[1]", "pins particle 0 like pins[0], but with another motion")));
  EXPECT_THAT(build_problems({"bodies.banner.pins=[{\"indices\":[0],\"until\":2},{\"indices\":[1,0],\"from\":1}]"}),
              ElementsAre(problem("bodies.banner.pins[1]", "pins particle 0 like pins[0], but at the same time")));
  EXPECT_THAT(build_problems({"bodies.banner.pins=[{\"sphere\":[[0,0,3],2.5]}]"}),
              ElementsAre(AllOf(problem("bodies.banner.pins[0].sphere", "contains no particle"),
                                Field(&Problem::remedy, HasSubstr("the nearest particle is 3 m from its centre")))));
}

// A tetrahedron of 4 vertices, whose edges are four to six cells long.
TEST(SceneBuilder, ScenesDoNotNameTheVerticesThatContactAloneHas) {
  const SceneFolder folder;
  folder.write("coarse.obj", kTetrahedron);
  const auto build_with_pins = [&](const std::string& pins) {
    return build(folder, {R"(bodies.banner={"shape":{"type":"lattice","file":"coarse.obj","cells":4},"particle_mass":0.5,
                             "springs":{"structural":{"stiffness":10}},"pins":[)" +
                          pins + "]}"});
  };
  const BuiltScene built = build_with_pins(R"({"indices":[3,4]})");
  const Body& body = built.network.bodies[0];
  EXPECT_EQ(body.exported_vertex_count(), 4);
  EXPECT_GT(body.contact_only, 6 * 3) << "three or more on each edge";
  const Index first_corner = body.contact_vertex_count();
  EXPECT_THAT(pinned(built.network), ElementsAre(3, first_corner)) << "corners of cells follow the vertices of the file";
  const Index named = body.particle_count - body.contact_only;
  EXPECT_NEAR(built.network.masses.sum(), 0.5 * named, 1.0e-10);
  EXPECT_THAT(problems_of([&] { (void)build_with_pins("{\"indices\":[" + std::to_string(named) + "]}"); }),
              ElementsAre(problem("bodies.banner.pins[0].indices[0]", "the body has " + std::to_string(named) + " particles")));
  const std::vector<Index> in_box = pinned(build_with_pins(R"({"box":[[-9,-9,-9],[9,9,9]]})").network);
  EXPECT_EQ(std::ssize(in_box), named);
  EXPECT_THAT(pinned(build_with_pins(R"({"nearest":[0.5,0,0]})").network), Each(Ge(first_corner))) << "not the middle of an edge";
}

TEST(SceneBuilder, MeshesAreFoundBesideTheSceneThenInTheMeshPathsInOrder) {
  const SceneFolder folder;
  folder.write("first/mesh.obj", std::string(kTetrahedron) + "v 5 5 5\nv 6 5 5\nv 5 6 5\nf 5 6 7\n");
  folder.write("second/mesh.obj", kTetrahedron);
  const std::vector<std::filesystem::path> paths{folder.path() / "first", folder.path() / "second"};
  const std::vector<std::string> change{"obstacles.floor.shape={\"type\":\"mesh\",\"file\":\"mesh.obj\"}"};
  EXPECT_EQ(build(folder, change, paths).meshes[0].report.components, 2);
  EXPECT_EQ(build(folder, change, {paths[1], paths[0]}).meshes[0].report.components, 1);
  const auto beside = folder.write("mesh.obj", kTetrahedron);
  EXPECT_EQ(build(folder, change, paths).meshes[0].file, beside);
}

TEST(SceneBuilder, AMissingMeshIsReportedWithTheTriedPaths) {
  const SceneFolder folder;
  const auto problems = problems_of(
      [&] { (void)build(folder, {"obstacles.floor.shape={\"type\":\"mesh\",\"file\":\"no.obj\"}"}, {"/nowhere/meshes"}); });
  ASSERT_THAT(problems, ElementsAre(problem("obstacles.floor.shape.file", "no such file: looked for ")));
  EXPECT_THAT(problems[0].rule, AllOf(HasSubstr((folder.path() / "no.obj").string()), HasSubstr("/nowhere/meshes/no.obj")));
  EXPECT_THAT(problems[0].remedy, AllOf(HasSubstr("--mesh-path"), HasSubstr("SPRUNG_MESH_PATH"), Not(HasSubstr("did you mean"))));
}

TEST(SceneBuilder, AMissingMeshIsReportedWithTheNearestName) {
  const SceneFolder folder;
  folder.write("first/meshes/bunny.obj", kTetrahedron);
  const std::vector<std::string> change{R"(obstacles.floor.shape={"type":"mesh","file":"meshes/buny.OBJ"})"};
  const auto problems = problems_of([&] { (void)build(folder, change, {folder.path() / "first"}); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0].remedy, HasSubstr("did you mean \"meshes/bunny.obj\"?"));
}

// In the folder of the scene, and in its folder meshes: the folder left out, misspelt, and right.
TEST(SceneBuilder, AMissingMeshIsLookedForInTheFoldersBelowToo) {
  const SceneFolder folder;
  folder.write("meshes/torus.ply", "");
  folder.write("old/torus.ply", "");
  for (const char* file : {"meshes/tours.ply", "mehses/torus.ply", "mehses/tours.ply", "tours.ply"}) {
    const auto problems =
        problems_of([&] { (void)build(folder, {std::string(R"(obstacles.floor.shape={"type":"mesh","file":")") + file + "\"}"}); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(problems[0].remedy, HasSubstr("did you mean \"meshes/torus.ply\"?")) << file;
  }
}

TEST(SceneBuilder, ObstacleMeshesAreSharedUnlessScaled) {
  const SceneFolder folder;
  folder.write("mesh.obj", kTetrahedron);
  const BuiltScene built =
      build(folder, {R"(obstacles.a={"shape":{"type":"mesh","file":"mesh.obj"},"place":{"scale":3,"position":[0,-3,0]}})",
                     R"(obstacles.b={"shape":{"type":"mesh","file":"mesh.obj"}})",
                     R"(obstacles.c={"shape":{"type":"mesh","file":"mesh.obj"}})"});
  const auto& larger = std::get<MeshGeometry>(built.obstacles[1].geometry);
  EXPECT_EQ(larger.mesh->vertices.maxCoeff(), 3.0);
  EXPECT_TRUE(larger.closed);
  EXPECT_EQ(built.obstacles[1].rest_pose.translation(), Vector3(0, -3, 0));
  EXPECT_EQ(std::get<MeshGeometry>(built.obstacles[2].geometry).mesh, std::get<MeshGeometry>(built.obstacles[3].geometry).mesh);
  EXPECT_EQ(built.meshes.size(), 3U);
}

std::string tetrahedron(const std::string& tip) {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + tip + "\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

TEST(SceneBuilder, SequencesAreScaledAndTimed) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron("1"));
  folder.write("b.obj", tetrahedron("2"));
  const BuiltScene built = build(folder, {R"(obstacles.heart={"shape":{"type":"sequence","files":["b.obj","a.obj","b.obj"],
                                             "frame_rate":24,"start":0.5,"loop":true},"place":{"scale":2,"position":[0,-3,0]}})"});
  const auto& [sequence, closed] = std::get<SequenceGeometry>(built.obstacles[1].geometry);
  ASSERT_EQ(sequence->frames.size(), 3U);
  EXPECT_EQ(sequence->frames[0].col(3), Vector3(0, 0, 4));
  EXPECT_EQ(sequence->frames[1].col(3), Vector3(0, 0, 2));
  EXPECT_EQ(sequence->frame_rate, 24.0);
  EXPECT_EQ(sequence->start, 0.5);
  EXPECT_TRUE(sequence->loop);
  EXPECT_TRUE(closed);
  EXPECT_TRUE(built.obstacles[1].changes());
  ASSERT_EQ(built.meshes.size(), 1U);
  EXPECT_EQ(built.meshes[0].file, folder.path() / "b.obj");
  EXPECT_EQ(built.meshes[0].files, 3U);
  EXPECT_EQ(built.meshes[0].report.bounds.max().z(), 2.0) << "before scaling, like those of other meshes";
}

TEST(SceneBuilder, PatternsOfSequencesAreSortedByNumber) {
  const SceneFolder folder;
  for (const char* number : {"9", "10", "1", "100", "11"}) {
    folder.write(std::string("breath/lung.") + number + ".obj", tetrahedron(number));
  }
  folder.write("breath/other.2.obj", "not a frame");
  folder.write("breath/lung.2.obj.bak", "not a frame");
  const BuiltScene built = build(folder, {R"(obstacles.lung={"shape":{"type":"sequence","files":"breath/lung.*.obj"}})"});
  std::vector<double> tips;
  for (const Points& frame : std::get<SequenceGeometry>(built.obstacles[1].geometry).sequence->frames) tips.push_back(frame(2, 3));
  EXPECT_THAT(tips, ElementsAre(1.0, 9.0, 10.0, 11.0, 100.0));
  EXPECT_THAT(built.warnings, Contains(HasSubstr("\"lung\": the file numbers have a gap after lung.1.obj")));
}

TEST(SceneBuilder, PatternsUseTheFirstFolderWithAnyMatch) {
  const SceneFolder folder;
  for (const char* name : {"paths/lung.1.obj", "paths/lung.2.obj", "paths/lung.3.obj"}) folder.write(name, tetrahedron("1"));
  const std::vector<std::string> change{R"(obstacles.lung.shape={"type":"sequence","files":"lung.*.obj"})"};
  EXPECT_EQ(build(folder, change, {folder.path() / "paths"}).meshes[0].files, 3U);
  for (const char* name : {"lung.1.obj", "lung.2.obj"}) folder.write(name, tetrahedron("2"));
  EXPECT_EQ(build(folder, change, {folder.path() / "paths"}).meshes[0].files, 2U);
}

TEST(SceneBuilder, InvalidSequencesAreProblems) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron("1"));
  folder.write("one.1.obj", tetrahedron("1"));
  const auto other = folder.write("other.obj", kTetrahedron + std::string("v 1 1 1\n"));
  const auto problems = [&](const std::string& files) {
    const std::string shape = R"({"shape":{"type":"sequence","files":)" + files + "}}";
    return problems_of([&] { (void)build(folder, {"obstacles.lung=" + shape, "obstacles.heart=" + shape}); });
  };
  const auto both = [](const std::string& key, const std::string& rule) {
    return ElementsAre(problem("obstacles.lung.shape." + key, rule), problem("obstacles.heart.shape." + key, rule));
  };
  EXPECT_THAT(problems(R"("none.*.obj")"), both("files", "no file matches: looked for "));
  EXPECT_THAT(problems(R"("one.*.obj")"), both("files", "matches one file only"));
  EXPECT_THAT(problems(R"(["a.obj", "none.obj"])"), both("files[1]", "no such file: looked for "));
  EXPECT_THAT(
      problems(R"(["a.obj", "other.obj"])"),
      ElementsAre(AllOf(Field(&Problem::file, other.string()), Field(&Problem::rule, HasSubstr("equally many as in a.obj")))))
      << "once, although two obstacles use them";
}

TEST(SceneBuilder, WarnsOfASequenceThatDoesNotDeform) {
  const SceneFolder folder;
  folder.write("a.obj", tetrahedron("1"));
  EXPECT_THAT(build(folder, {R"(obstacles.lung.shape={"type":"sequence","files":["a.obj","a.obj"]})"}).warnings,
              ElementsAre(HasSubstr("obstacle \"lung\": all frames are equal")));
}

TEST(SceneBuilder, WarnsOfUnitsByTheScaledSizeOfAMesh) {
  const SceneFolder folder;
  folder.write("mesh.obj", "v 0 0 0\nv 18000 0 0\nv 0 18000 0\nf 1 2 3\n");
  const std::string shape = R"(obstacles.a.shape={"type":"mesh","file":"mesh.obj"})";
  EXPECT_THAT(build(folder, {shape, "obstacles.a.place.scale=0.001"}).warnings, IsEmpty());
  EXPECT_THAT(build(folder, {shape}).warnings, ElementsAre(HasSubstr("obstacle \"a\": its largest extent is 18000 m")));
}

// The banner is 1 m large.
TEST(SceneBuilder, WarnsOfMeshesFarLargerThanTheRestOnceWithTheirNames) {
  const SceneFolder folder;
  folder.write("mesh.obj", "v 0 0 0\nv 101 0 0\nv 0 101 0\nf 1 2 3\n");
  const auto warnings = [&](const std::string& scale) {
    const std::string shape = R"({"shape":{"type":"mesh","file":"mesh.obj"},"place":{"scale":)" + scale + "}}";
    return build(folder, {"obstacles.a=" + shape, "obstacles.b=" + shape}).warnings;
  };
  EXPECT_THAT(warnings("1"),
              ElementsAre(HasSubstr("obstacles \"a\" and \"b\": its largest extent is 101 m: if the file is in mill")));
  EXPECT_THAT(warnings("0.99"), IsEmpty());
  folder.write("cup.obj", "v 0 0 0\nv 80 0 0\nv 0 80 0\nf 1 2 3\n");
  const std::string cup = R"(obstacles.cup.shape={"type":"mesh","file":"cup.obj"})";
  EXPECT_THAT(build(folder, {cup}).warnings, IsEmpty());
  EXPECT_THAT(build(folder, {cup, "bodies.banner.shape.size=[0.5,0.5]"}).warnings,
              ElementsAre(HasSubstr("obstacle \"cup\": its largest extent is 80 m, 160 times that of anything else in the scene")));
  folder.write("body.obj", "v 0 0 0\nv 632 0 0\nv 0 632 0\nf 1 2 3\n");
  EXPECT_THAT(
      build(folder, {R"(bodies.banner.shape={"type":"mesh","file":"body.obj"})", "bodies.banner.pins=[]", "bodies.banner.mass=4e4"})
          .warnings,
      ElementsAre(HasSubstr("body \"banner\": its largest extent is 632 m: if")));
}

TEST(SceneBuilder, WarnsOfSpringsThatAShapeDoesNotHave) {
  const SceneFolder folder;
  EXPECT_THAT(build(folder, {"bodies.banner.shape.resolution=[2,2]", "bodies.banner.springs.bend.stiffness=1"}).warnings,
              ElementsAre("body \"banner\": springs.bend has no effect: its shape has no such springs. Remove it."));
  EXPECT_THAT(build(folder, {"bodies.banner.springs.bend={\"stiffness\":1,\"model\":\"angle\"}",
                             "bodies.banner.springs.structural.stiffness=1e4"})
                  .warnings,
              IsEmpty());
}

TEST(SceneBuilder, SpringsOfAMaterialThatAMeshDoesNotHaveCauseNoWarning) {
  const SceneFolder folder;
  folder.write("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(build(folder, {R"(bodies.banner={"shape":{"type":"mesh","file":"body.obj"},"material":"silk"})"}).warnings,
              IsEmpty());
}

TEST(SceneBuilder, PrimitivesAreScaled) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {R"(obstacles.a={"shape":{"type":"capsule","radius":1,"length":2},"place":{"scale":3}})",
                                          R"(obstacles.b={"shape":{"type":"box","size":[1,2,3]},"place":{"scale":2}})"});
  EXPECT_EQ(std::get<CapsuleGeometry>(built.obstacles[1].geometry).radius, 3.0);
  EXPECT_EQ(std::get<CapsuleGeometry>(built.obstacles[1].geometry).length, 6.0);
  EXPECT_EQ(std::get<BoxGeometry>(built.obstacles[2].geometry).size, Vector3(2, 4, 6));
}

TEST(SceneBuilder, BodyMeshesAreReadInTheirOrder) {
  const SceneFolder folder;
  folder.write("body.OBJ", kTetrahedron);
  const BuiltScene built = build(
      folder, {R"(bodies.banner.shape={"type":"mesh","file":"body.OBJ"})", "bodies.banner.pins=[]", "bodies.banner.place.scale=2"});
  EXPECT_EQ(built.network.positions.col(3), Vector3(0, 0, 2));
  EXPECT_EQ(built.network.springs.count(), 6);
}

TEST(SceneBuilder, TetrahedraAreReadAndScaled) {
  const SceneFolder folder;
  folder.write("corner.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  folder.write("corner.ele", "1 4 0\n1 1 2 3 4\n");
  for (const char* file : {"corner.node", "corner.ele"}) {
    const BuiltScene built = build(folder, {std::string(R"(bodies.banner.shape={"type":"tetrahedra","file":")") + file + "\"}",
                                            "bodies.banner.pins=[{\"nearest\":[0,0,9]}]", "bodies.banner.place.scale=2"});
    EXPECT_EQ(built.network.positions.col(3), Vector3(0, 0, 2));
    EXPECT_EQ(built.network.springs.count(), 6);
    EXPECT_EQ(built.network.springs.stiffness[2], 400.0);
    EXPECT_EQ(built.network.bodies[0].surface.triangles.cols(), 4);
    EXPECT_DOUBLE_EQ(built.network.bodies[0].measure, 8.0 / 6.0);
    EXPECT_THAT(pinned(built.network), ElementsAre(3));
  }
}

TEST(SceneBuilder, ProblemsOfTetrahedraNameTheirFile) {
  const SceneFolder folder;
  folder.write("corner.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  folder.write("corner.ele", "1 4 0\n1 1 2 3 5\n");
  const auto problems = problems_of([&] {
    (void)build(folder, {R"(bodies.banner.shape={"type":"tetrahedra","file":"corner.node"})", "bodies.banner.pins=[]"});
  });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(to_string(problems[0]), HasSubstr("corner.ele: line 2 = 5: must be the number of one of the 4 nodes"));
}

TEST(SceneBuilder, AFolderIsNoMesh) {
  EXPECT_THAT(build_problems({R"(obstacles.floor.shape={"type":"mesh","file":"."})"}),
              ElementsAre(problem("obstacles.floor.shape.file", "is a folder")));
}

TEST(SceneBuilder, BodyMeshesOfOtherFormatsAreRefused) {
  EXPECT_THAT(build_problems({R"(bodies.banner.shape={"type":"mesh","file":"body.stl"})", "bodies.banner.pins=[]"}),
              ElementsAre(problem("bodies.banner.shape.file", "read from an .obj file")));
}

TEST(SceneBuilder, FilesOfTetrahedraNameTheShapeThatReadsThem) {
  for (const char* shape : {R"({"type":"mesh","file":"ham.msh"})", R"({"type":"lattice","file":"ham.vtk","cells":8})"}) {
    EXPECT_THAT(build_problems({std::string("bodies.banner.shape=") + shape, "bodies.banner.pins=[]"}),
                ElementsAre(AllOf(problem("bodies.banner.shape.file", "has the format of tetrahedra"),
                                  Field(&Problem::remedy, HasSubstr("\"type\": \"tetrahedra\"")))));
  }
  EXPECT_THAT(build_problems({R"(obstacles.floor.shape={"type":"mesh","file":"ham.ele"})"}),
              ElementsAre(AllOf(problem("obstacles.floor.shape.file", "has the format of tetrahedra"),
                                Field(&Problem::remedy, HasSubstr("or make it a body of type \"tetrahedra\"")))));
}

TEST(SceneBuilder, ProblemsOfAllBodiesObstaclesAndTheStepAreReportedTogether) {
  EXPECT_THAT(
      build_problems({"bodies.banner.pins[0]={\"indices\":[99]}",
                      R"(bodies.shirt={"shape":{"type":"mesh","file":"shirt.obj"},"mass":1})",
                      R"(obstacles.bunny={"shape":{"type":"mesh","file":"bunny.obj"}})"}),
      ElementsAre(problem("bodies.banner.pins[0].indices[0]", "9 particles"), problem("bodies.shirt.shape.file", "no such file"),
                  problem("obstacles.bunny.shape.file", "no such file")));
  EXPECT_THAT(
      build_problems({"step=0.03333333333333333", R"(obstacles.bunny={"shape":{"type":"mesh","file":"bunny.obj"}})"}),
      ElementsAre(problem("obstacles.bunny.shape.file", "no such file"), problem("step", "is beyond the largest stable step")));
}

TEST(SceneBuilder, AngleBendsAreMadeIfTheSceneSelectsThem) {
  const SceneFolder folder;
  const BuiltScene built = build(folder, {"bodies.banner.springs.bend={\"model\":\"angle\",\"stiffness\":0.5}"});
  // 3 x 3 particles: one per row and column.
  EXPECT_THAT(built.network.angle_bends.stiffness, ::testing::ElementsAre(0.5, 0.5, 0.5, 0.5, 0.5, 0.5));
  const std::vector<Problem> problems = problems_of([&] {
    build(folder, {"bodies.banner.shape={\"type\":\"solid\",\"size\":[1,1,1],\"resolution\":[2,2,2]}", "bodies.banner.pins=[]",
                   "bodies.banner.springs.bend={\"model\":\"angle\",\"stiffness\":0.5}"});
  });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].key, "bodies.banner.springs.bend.model");
}

TEST(SceneBuilder, WarnsOfABodyWithoutSprings) {
  const SceneFolder folder;
  EXPECT_THAT(build(folder, {"bodies.banner.springs={}"}).warnings, ElementsAre(HasSubstr("body \"banner\": no springs")));
}

TEST(SceneBuilder, TellsEqualWarningsOnce) {
  const SceneFolder folder;
  const std::string loose = R"({"shape": {"type": "rope", "from": [0, 5, 0], "to": [1, 5, 0], "particles": 3}, "mass": 1})";
  EXPECT_THAT(build(folder, {"bodies.banner.springs={}", "bodies.one=" + loose, "bodies.two=" + loose}).warnings,
              ElementsAre(HasSubstr("bodies \"banner\", \"one\" and 1 more: no springs")));
}

// Two triangles side by side that share no vertex, and a vertex of its own.
TEST(SceneBuilder, WarnsOfPiecesThatNoSpringJoins) {
  const SceneFolder folder;
  folder.write("loose.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nf 1 2 3\nf 4 5 6\n");
  const auto warnings = [&](const std::string& file) {
    return build(folder, {R"(bodies.banner={"shape": {"type": "mesh", "file": ")" + file +
                          R"("}, "mass": 1, "springs": {"structural": {"stiffness": 1}}})"})
        .warnings;
  };
  EXPECT_THAT(warnings("loose.obj"), ::testing::UnorderedElementsAre(HasSubstr("1 particle without a spring"),
                                                                     HasSubstr("3 pieces that no spring joins")));
  folder.write("joined.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  EXPECT_THAT(warnings("joined.obj"), IsEmpty());
  folder.write("apart.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 1 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_THAT(warnings("apart.obj"), IsEmpty()) << "pieces that do not touch, as strands of hair";
}

TEST(SceneBuilder, MeshPathsComeFromTheEnvironmentToo) {
  setenv("SPRUNG_MESH_PATH", "/a/b::/c", 1);
  EXPECT_THAT(all_mesh_paths({"d"}), ElementsAre("d", "/a/b", "/c"));
  unsetenv("SPRUNG_MESH_PATH");
  EXPECT_THAT(all_mesh_paths({}), IsEmpty());
}

struct BrokenMesh {
  std::string name;
  std::string text;
  std::string message;
  bool breaks_a_body = true;
};

std::ostream& operator<<(std::ostream& stream, const BrokenMesh& mesh) { return stream << mesh.name; }

class BrokenMeshTest : public testing::TestWithParam<BrokenMesh> {};

TEST_P(BrokenMeshTest, IsRefusedAsAnObstacleNamingTheFile) {
  const SceneFolder folder;
  const auto file = folder.write("broken.obj", GetParam().text);
  const auto problems = problems_of([&] { (void)build(folder, {R"(obstacles.floor.shape={"type":"mesh","file":"broken.obj"})"}); });
  EXPECT_THAT(problems,
              Contains(AllOf(Field(&Problem::file, file.string()), Field(&Problem::rule, HasSubstr(GetParam().message)))));
}

TEST_P(BrokenMeshTest, IsReportedOnceIfSeveralObstaclesUseIt) {
  const SceneFolder folder;
  folder.write("broken.obj", GetParam().text);
  const std::string first = R"(obstacles.a={"shape":{"type":"mesh","file":"broken.obj"}})";
  const std::string second = R"(obstacles.b={"shape":{"type":"mesh","file":"broken.obj"}})";
  const auto problems_with = [&](const std::vector<std::string>& changes) {
    return problems_of([&] { (void)build(folder, changes); }).size();
  };
  EXPECT_EQ(problems_with({first, second}), problems_with({first}));
}

TEST_P(BrokenMeshTest, IsRefusedAsABodyNamingTheFile) {
  if (!GetParam().breaks_a_body) return;
  const SceneFolder folder;
  const auto file = folder.write("broken.obj", GetParam().text);
  const auto problems = problems_of([&] {
    (void)build(folder, {R"(bodies.banner.shape={"type":"mesh","file":"broken.obj"})", "bodies.banner.pins=[]"});
  });
  EXPECT_THAT(problems, Contains(Field(&Problem::file, file.string())));
}

INSTANTIATE_TEST_SUITE_P(SceneBuilder, BrokenMeshTest,
                         testing::Values(BrokenMesh{"Empty", "", "empty"},
                                         BrokenMesh{"Truncated", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", ""},
                                         BrokenMesh{"NotFinite", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", ""},
                                         BrokenMesh{"HugeIndex", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2000000000\n", ""},
                                         BrokenMesh{"NoFaces", "v 0 0 0\nv 1 0 0\n", "", false},
                                         BrokenMesh{"NoArea", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "", false}),
                         [](const auto& test) { return test.param.name; });

/// A cloth of cotton, a rope of hemp, a block of foam and a cloth without a material.
constexpr const char* kMaterials = R"({"duration": 1, "bodies": {
  "towel": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "material": "cotton"},
  "line": {"shape": {"type": "rope", "from": [0, 2, 0], "to": [1, 2, 0], "particles": 3}, "material": "hemp"},
  "block": {"shape": {"type": "solid", "size": [1, 1, 1], "resolution": [2, 2, 2]}, "place": {"position": [0, 4, 0]},
            "material": "foam"},
  "plain": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [3, 3]}, "mass": 0.2, "place": {"position": [0, 0, 1]},
            "springs": {"structural": {"stiffness": 400}}}}})";

// In the order of the scene: 0.6 kg/m^3 times 1.17 and 0.5.
TEST(SceneBuilder, BodiesWithAMaterialMoveInAir) {
  const SceneFolder folder;
  for (const std::vector<std::string>& changes :
       {std::vector<std::string>{}, {"air={}"}, {"air.wind=[1,0,0]"}, {R"(air.gusts={"speed":1,"length":1})"}}) {
    const Scene scene = folder.read(kMaterials, changes);
    for (const Scene& read : {scene, folder.read(scene.resolved)}) {
      const BuiltScene built = build_scene(read);
      const std::vector<Body>& bodies = built.network.bodies;
      EXPECT_DOUBLE_EQ(bodies[0].drag.normal, 0.6 * 1.17);
      EXPECT_EQ(bodies[1].drag.line_diameter, 0.012);
      EXPECT_DOUBLE_EQ(bodies[2].drag.normal, 0.6 * 0.5);
      EXPECT_TRUE(bodies[3].drag.is_zero());
      EXPECT_EQ(built.settings.wind.is_calm(), changes.empty() || changes[0] == "air={}");
      EXPECT_FALSE(built.settings.has_air());
    }
  }
  const BuiltScene thick = build_scene(folder.read(kMaterials, {"bodies.line.diameter=0.02"}));
  EXPECT_EQ(thick.network.bodies[1].drag.line_diameter, 0.02);
}

// A drag or surface that is given stands for the whole of the air, also if it is zero.
TEST(SceneBuilder, BodiesWithAMaterialMoveInVacuumOrByAGivenDrag) {
  const SceneFolder folder;
  for (const char* air : {"air=false", "air.drag=0", "air.drag=0.1", "air.surface={}", R"(air.surface={"normal":1})"}) {
    const Scene scene = folder.read(kMaterials, {air});
    for (const Scene& read : {scene, folder.read(scene.resolved)}) {
      for (const Body& body : build_scene(read).network.bodies) EXPECT_TRUE(body.drag.is_zero()) << air;
    }
  }
}

}  // namespace
}  // namespace sprung
