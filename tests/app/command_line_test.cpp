// The program from outside: what it accepts, what it says where, and what it writes.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>

#include <algorithm>
#include <regex>

namespace sprung {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using testing::cloth_scene;
using testing::CommandLine;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using testing::Ending;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::listing;
using ::testing::Not;
using testing::Program;
using testing::read_text;
using testing::rope_scene;
using ::testing::StartsWith;
using testing::write_text;

TEST_F(CommandLine, RunWritesTheFramesAndSaysSoOnStandardErrorOnly) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.out, "");
  EXPECT_THAT(ending.err, HasSubstr("7 frames"));
  EXPECT_THAT(ending.err, HasSubstr("frame 7/7"));
  EXPECT_THAT(listing(out()), ElementsAre("checkpoint.bin", "diagnostics.csv", "record.bin", "rope/", "rope/rope.0001.obj",
                                          "rope/rope.0002.obj", "rope/rope.0003.obj", "rope/rope.0004.obj", "rope/rope.0005.obj",
                                          "rope/rope.0006.obj", "rope/rope.0007.obj", "run.json"));
  EXPECT_EQ(summary()["outcome"], "done");
  EXPECT_EQ(summary()["frames_written"], 7);
  EXPECT_EQ(summary()["scene"]["bodies"]["rope"]["mass"], 0.1);
}

TEST_F(CommandLine, RunWithFormatNoneWritesNoObjFiles) {
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out(), "--format", "none"}).code, 0);
  EXPECT_THAT(listing(out()), ElementsAre("checkpoint.bin", "diagnostics.csv", "record.bin", "run.json"));
  EXPECT_THAT(summary()["files"].get<std::vector<std::string>>(), ::testing::Contains("record.bin"));
  const Ending unknown = run({"run", save(rope_scene()), "--out", out(), "--overwrite", "--format", "fbx"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--format"));
}

TEST_F(CommandLine, RunRecordsTheSeedThatItUses) {
  EXPECT_EQ(run({"run", save(rope_scene()), "--set", "seed=7", "--out", out()}).code, 0);
  EXPECT_EQ(summary()["seed"], 7);
  EXPECT_EQ(run({"run", save(rope_scene()), "--set", "perturb=false", "--out", out(), "--overwrite"}).code, 0);
  EXPECT_TRUE(summary()["seed"].is_null());
  const Ending scattered = run({"run", save(rope_scene()), "--set", "perturb=false", "--set", "bodies.rope.material=\"hemp\"",
                                "--set", "bodies.rope.springs.structural.break=0.5", "--out", out(), "--overwrite"});
  EXPECT_EQ(scattered.code, 0) << scattered.err;
  EXPECT_EQ(summary()["seed"], 0) << "strengths scatter by it";
}

// A row for each of 7 frames and 2 pins; from the first frame on the pins hold the rope together.
TEST_F(CommandLine, RunWritesTheForcesOfPinsOnRequest) {
  json scene = rope_scene();
  scene["bodies"]["rope"]["pins"].push_back({{"indices", {4}}, {"until", 0.1}});
  EXPECT_EQ(run({"run", save(scene), "--set", "output.forces=true", "--out", out()}).code, 0);
  const std::string text = read_text(scratch_ / "out/forces.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 7 * 2);
  EXPECT_THAT(text, StartsWith("frame,time,name,force_x,force_y,force_z\n1,0,rope.pins[0],0,0,0\n1,0,rope.pins[1],0,0,0\n2,"));
  EXPECT_THAT(text, EndsWith(",rope.pins[1],0,0,0\n"));
  EXPECT_THAT(summary()["files"], Contains("forces.csv"));
  EXPECT_EQ(summary()["scene"]["output"]["forces"], true);
  EXPECT_EQ(run({"run", save(scene), "--out", out(), "--overwrite"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "out/forces.csv"));
  EXPECT_EQ(summary()["scene"]["output"]["forces"], false);
}

TEST_F(CommandLine, QuietSaysNothing) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--quiet"});
  EXPECT_EQ(ending.code, 0);
  EXPECT_EQ(ending.out + ending.err, "");
}

TEST_F(CommandLine, LinesAreFewWhenFramesAreMany) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--frames", "2000"});
  EXPECT_EQ(ending.code, 0);
  EXPECT_THAT(ending.err, HasSubstr("frame 2000/2000"));
  // The head, ten parts, a line every 5 s (a slow machine may need a minute), and the end.
  EXPECT_LE(std::count(ending.err.begin(), ending.err.end(), '\n'), 1 + 10 + 12 + 1);
}

TEST_F(CommandLine, TerminalShowsABarWithTimeLeft) {
  int terminal = -1;
  int program_side = -1;
  ASSERT_EQ(::openpty(&terminal, &program_side, nullptr, nullptr, nullptr), 0);
  Program program({"run", save(rope_scene()), "--out", out()}, {.error_descriptor = program_side});
  const Ending ending = program.wait();
  ::close(program_side);
  std::string shown(10'000, '\0');
  shown.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(terminal, shown.data(), shown.size()))));
  ::close(terminal);
  EXPECT_EQ(ending.code, 0);
  EXPECT_THAT(shown, AllOf(HasSubstr("\r[####"), HasSubstr("frame 1/7"), HasSubstr("ms per frame"), HasSubstr("left"),
                           HasSubstr("[##############################] frame 7/7")));
}

// No name with the number of a frame is taken for another name.
TEST_F(CommandLine, NamesMayEndInADigit) {
  json scene = rope_scene();
  for (const char* name : {"rope1", "rope10", "1"}) scene["bodies"][name] = scene["bodies"]["rope"];
  for (json& body : scene["bodies"]) body["body_contact"] = false;
  scene["obstacles"]["ball2"] = {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"motion", {{"spin", {0, 90, 0}}}}};
  scene["obstacles"]["2"] = {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}};
  const std::string file = save(scene);
  const std::vector<std::string> words{"run", file, "--out", out(), "--frames", "2", "--set", "bodies.rope1.mass=0.25"};
  ASSERT_EQ(run(words).code, 0);
  const std::vector<std::string> before = listing(out());
  EXPECT_THAT(before, ::testing::IsSupersetOf({"1/1.0002.obj", "rope/rope.0002.obj", "rope1/rope1.0002.obj",
                                               "rope10/rope10.0002.obj", "obstacles/2.obj", "obstacles/ball2/ball2.0002.obj"}));
  EXPECT_EQ(summary()["scene"]["bodies"]["rope1"]["mass"], 0.25);
  EXPECT_EQ(run({"run", file, "--out", out(), "--frames", "2", "--overwrite"}).code, 0);
  EXPECT_EQ(listing(out()), before);
}

TEST_F(CommandLine, SetReplacesValuesAndFramesTheDuration) {
  const Ending ending = run({"run", "--set", "bodies.rope.mass=0.25", "--set", "bodies.rope.shape.particles=9", save(rope_scene()),
                             "--frames", "2", "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(summary()["frames"], 2);
  EXPECT_EQ(summary()["scene"]["bodies"]["rope"]["mass"], 0.25);
  EXPECT_THAT(read_text(scratch_ / "out/rope/rope.0002.obj"), HasSubstr("l 8 9\n"));
}

TEST_F(CommandLine, PathsMayHoldSpacesAndAnyScript) {
  const std::string scene = save(rope_scene(), "ein Ordner/Tüch 布.json");
  const std::string frames = out("Bilder für 布 & Co");
  EXPECT_EQ(run({"run", scene, "--out", frames}).code, 0);
  EXPECT_THAT(listing(frames), Contains("rope/rope.0007.obj"));
}

TEST_F(CommandLine, SameBitsForAnyNumberOfThreadsAndEachRun) {
  const std::string scene = save(cloth_scene());
  EXPECT_EQ(run({"run", scene, "--out", out("one"), "--threads", "1"}).code, 0);
  EXPECT_EQ(run({"run", scene, "--out", out("two"), "--threads", "2"}).code, 0);
  EXPECT_EQ(run({"run", scene, "--out", out("again"), "--threads", "2"}).code, 0);
  for (const std::string& name : listing(out("one"))) {
    if (!name.ends_with(".obj")) continue;
    const std::string text = read_text(scratch_ / ("one/" + name));
    EXPECT_TRUE(text == read_text(scratch_ / ("two/" + name))) << name;
    EXPECT_TRUE(text == read_text(scratch_ / ("again/" + name))) << name;
  }
  EXPECT_THAT(listing(out("one")), Contains("cloth/cloth.0007.obj"));
}

TEST_F(CommandLine, RunWarnsOnceOfInfeasibleVerticesBetweenObstacles) {
  json scene = rope_scene();
  scene["bodies"]["rope"].erase("pins");
  scene["bodies"]["rope"]["place"]["position"] = {0, -1.9, 0};  // 0.1 m above the anvil
  scene["obstacles"]["anvil"]["shape"] = {{"type", "half_space"}};
  scene["obstacles"]["hammer"] = {
      {"shape", {{"type", "box"}, {"size", {4, 1, 4}}}},
      {"place", {{"position", {0, 0.7, 0}}}},
      {"motion", {{"keyframes", {{{"time", 0}, {"position", {0, 0, 0}}}, {{"time", 0.1}, {"position", {0, -0.5, 0}}}}}}}};
  const Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, AllOf(HasSubstr("had no admissible position"), HasSubstr("Increase the clearance")));
  ASSERT_EQ(summary()["warnings"].size(), 1U);
  EXPECT_THAT(summary()["warnings"][0].get<std::string>(), StartsWith("frame "));
}

// Each of the 100 particles is infeasible in each step, which the column sums.
TEST_F(CommandLine, RunCountsEachPinnedVertexInAnObstacleOnce) {
  json scene = cloth_scene();
  json& cloth = scene["bodies"]["cloth"];
  cloth["shape"]["resolution"] = {10, 10};
  cloth["place"]["position"] = {0, -0.3, 0};
  cloth["pins"] = {{{"box", {{-1, -1, -1}, {1, 1, 1}}}}};
  scene["obstacles"] = {{"floor", {{"shape", {{"type", "half_space"}, {"offset", 0}}}}}};
  scene["step"] = 1.0 / 120.0;
  const Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err,
              AllOf(HasSubstr("frame 2: 100 vertices had no admissible position"), HasSubstr("move pins out of obstacles")));
}

TEST_F(CommandLine, RunReportsAMissedStretchLimitAndTheRemedy) {
  json scene = rope_scene();
  scene["bodies"]["rope"]["shape"]["particles"] = 50;
  scene["step"] = 1.0 / 60.0;
  scene["frame_rate"] = 60;
  scene["bodies"]["rope"]["springs"] = {{"structural", {{"stiffness", 0}}}};
  scene["stretch_limit"] = {{"max_stretch", 0.0}, {"iterations", 1}, {"solver", "gauss_seidel"}};
  Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, AllOf(HasSubstr("stretch limit was missed"), HasSubstr(R"("solver": "auto")")));

  json borne = scene;  // it is missed by less than half of its play, which automatic steps are chosen for
  borne["duration"] = 0.5;
  borne["bodies"]["rope"]["shape"]["particles"] = 5;
  borne["stretch_limit"] = {{"max_stretch", 0.5}, {"tolerance", 0.0}, {"iterations", 1}, {"solver", "gauss_seidel"}};
  EXPECT_THAT(run({"run", save(borne), "--out", out(), "--overwrite"}).err, Not(HasSubstr("stretch limit was missed")));

  scene["stretch_limit"]["max_compression"] = 0.5;  // which passes alone hold
  ending = run({"run", save(scene), "--out", out(), "--overwrite"});
  EXPECT_THAT(ending.err,
              AllOf(HasSubstr("Raise \"iterations\" of \"stretch_limit\", or use a \"step\" of"), Not(HasSubstr("solver"))));
}

// Two hairs that touch at a jerk of their pins. Newton's method solves with any number of iterations; what it misses is in
// proportion to the step.
TEST_F(CommandLine, RunAdvisesASmallerStepWhereNewtonMissesTheLimit) {
  json scene = {{"duration", 0.4}};
  for (const char* name : {"a", "b"}) {
    const double x = name[0] == 'a' ? 0.0 : 0.01;
    scene["bodies"][name] = {{"shape", {{"type", "rope"}, {"from", {x, 1, 0}}, {"to", {x, 0.7, 0}}, {"particles", 31}}},
                             {"material", "hair"},
                             {"springs", {{"bend", {{"damping_time", 1e-5}}}}},
                             {"pins", json::parse(R"([{"indices": [0], "motion": {"keyframes": [
                                 {"time": 0.2}, {"time": 0.25, "position": [0.3, 0, 0]}, {"time": 0.3, "position": [0, 0, 0.2]}]}}])")}};
  }
  const std::string missed = run({"run", save(scene), "--out", out()}).err;
  const std::string times = " times smaller, or let pins and obstacles move more slowly.";
  const std::size_t end = missed.find(times);
  ASSERT_NE(end, std::string::npos) << missed;
  const int factor = std::stoi(missed.substr(missed.rfind(' ', end - 1)));
  const int steps_per_frame = summary()["steps_per_frame"];
  scene["step"] = 1.0 / (30.0 * steps_per_frame * factor);
  EXPECT_THAT(run({"run", save(scene), "--out", out(), "--overwrite"}).err, Not(HasSubstr("warning")));
}

// Undamped, and passing through itself, a soft rope gains from each spring that comes to no length.
TEST_F(CommandLine, RunReportsUnexplainedEnergy) {
  json scene = {{"version", 1}, {"duration", 40}, {"frame_rate", 10}, {"integrator", {{"type", "symplectic_euler"}}}};
  scene["bodies"]["rope"] = {{"shape", {{"type", "rope"}, {"from", {0, 0, 0}}, {"to", {1, 0, 0}}, {"particles", 40}}},
                             {"mass", 0.1},
                             {"springs", {{"structural", {{"stiffness", 100}}}, {"bend", {{"stiffness", 1}}}}},
                             {"pins", json::array({{{"at", "corner"}, {"which", {"from"}}}})},
                             {"velocity", {0, 3, 0.3}}};
  Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, AllOf(HasSubstr("nothing drives the scene"), HasSubstr("more damping")));
  EXPECT_THAT(summary()["warnings"], Contains(StartsWith("the total energy rose from")));

  scene["bodies"]["rope"]["springs"]["structural"]["damping"] = 0.05;
  EXPECT_THAT(run({"run", save(scene), "--out", out(), "--overwrite"}).err, Not(HasSubstr("warning")));
  scene["bodies"]["rope"]["springs"]["structural"].erase("damping");
  scene["bodies"]["rope"]["pins"][0]["motion"] = {{"spin", {0, 90, 0}}};
  EXPECT_THAT(run({"run", save(scene), "--out", out(), "--overwrite"}).err, Not(HasSubstr("nothing drives")));
}

TEST_F(CommandLine, RunReportsABodyTooThinToRestOnAnObstacle) {
  json scene = {{"version", 1}, {"duration", 1}, {"frame_rate", 30}};
  scene["obstacles"]["hills"]["shape"] = {{"type", "mesh"}, {"file", SPRUNG_SOURCE_DIR "/meshes/terrain.gltf"}};
  scene["bodies"]["cloth"] = {{"shape", {{"type", "cloth"}, {"size", {1, 1}}, {"resolution", {12, 12}}}},
                              {"mass", 0.1},
                              {"springs", {{"structural", {{"stiffness", 100}}}}},
                              {"place", {{"position", {0, 0.4, 0}}, {"rotation", {-90, 0, 0}}}}};
  Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("thickness 0 m is too small for the step"));

  scene["obstacles"]["hills"]["thickness"] = 0.005;
  ending = run({"run", save(scene), "--out", out(), "--overwrite"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, Not(HasSubstr("is too small for the step")));
}

TEST_F(CommandLine, RunReportsBodiesTooThinToRestOnEachOther) {
  json scene = {{"version", 1}, {"duration", 0.5}, {"frame_rate", 30}, {"stretch_limit", {{"max_stretch", 0.02}}}};
  scene["obstacles"]["floor"]["shape"] = {{"type", "half_space"}};
  for (const int layer : {1, 2, 3, 4}) {
    scene["bodies"][std::string("layer_") + static_cast<char>('a' + layer)] = {
        {"shape", {{"type", "cloth"}, {"size", {1, 1}}, {"resolution", {8, 8}}}},
        {"mass", 0.1},
        {"springs", {{"structural", {{"stiffness", 0}}}, {"shear", {{"stiffness", 0}}}}},
        {"place", {{"position", {0, 0.01 * layer, 0}}, {"rotation", {-90, 10 * layer, 0}}}}};
  }
  Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("thickness 0 m is too small for the step"));
  EXPECT_THAT(summary()["warnings"], Contains(StartsWith("thickness 0 m is too small")));

  for (json& body : scene["bodies"]) body["thickness"] = 0.005;
  ending = run({"run", save(scene), "--out", out(), "--overwrite"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, Not(HasSubstr("is too small for the step")));
}

TEST_F(CommandLine, ValidatePrintsDerivedQuantities) {
  const Ending ending = run({"validate", save(cloth_scene())});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.err, "");
  EXPECT_THAT(ending.out, AllOf(HasSubstr("4900 particles"), HasSubstr("9660 structural"), HasSubstr("9522 shear"),
                                HasSubstr("7 at 30 per second"), HasSubstr("(automatic)"), HasSubstr("largest stable substep"),
                                HasSubstr("ball: sphere"), HasSubstr("valid       the scene has no errors\n")));
  EXPECT_THAT(ending.out, HasSubstr("\nmaterial    friction 0.3, thickness 0.005 m\n"));
  json cotton = cloth_scene();
  cotton["bodies"]["cloth"] = {{"shape", cotton["bodies"]["cloth"]["shape"]}, {"material", "cotton"}, {"restitution", 0.1}};
  cotton["bodies"]["cloth"].update({{"friction", 0.25}, {"static_friction", 0.5}, {"thickness", 0.002}});
  cotton.erase("obstacles");
  EXPECT_THAT(run({"validate", save(cotton)}).out,
              HasSubstr("\nmaterial    cotton, friction 0.25 (0.5 static), thickness 0.002 m, restitution 0.1\n"));
}

TEST_F(CommandLine, ValidateMeasuresWhatAFrameCostsAndWritesNothing) {
  json scene = rope_scene();
  scene["obstacles"]["floor"]["shape"]["type"] = "half_space";
  const std::vector<std::string> command{"validate", save(scene), "--threads", "1"};
  const std::vector<std::string> files = listing(scratch_.path());
  const Ending ending = run(command);
  EXPECT_EQ(ending.code, 0) << ending.err;
  const std::string cost =
      "\ncost        free (below )?[0-9.]+ m?s a frame in motion \\([0-9]+ steps? measured\\), in full contact (below )?[0-9.]+ "
      "m?s "
      "\\(estimated\\), 1 thread\n";
  EXPECT_THAT(ending.out, ContainsRegex(cost));
  EXPECT_EQ(listing(scratch_.path()), files);
  const std::regex row(cost);
  EXPECT_EQ(std::regex_replace(run(command).out, row, ""), std::regex_replace(ending.out, row, ""));
  EXPECT_EQ(run({"validate", save(scene), "--threads", "0"}).code, 2);
}

TEST_F(CommandLine, ValidateTellsThatMirrorSymmetryIsLost) {
  json scene = cloth_scene();
  const auto symmetry = HasSubstr("symmetry    the bodies begin in mirror symmetry across x = 0 m");
  EXPECT_THAT(run({"validate", save(scene)}).out, symmetry);
  scene["bodies"]["cloth"]["pins"] = json::parse(R"([{"at": "corner", "which": ["min_min"]}])");
  EXPECT_THAT(run({"validate", save(scene)}).out, Not(HasSubstr("symmetry")));
}

TEST_F(CommandLine, ValidateTellsThatTheFirstStepsDiverge) {
  json scene = rope_scene();
  scene["step"] = 1.0 / 30.0;
  scene["stability"] = "warn";
  scene["bodies"]["rope"]["springs"]["structural"] = {{"stiffness", 1e9}};
  const Ending ending = run({"validate", save(scene)});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(HasSubstr("cost        unknown: the simulation diverges in its first steps\n"),
                                HasSubstr("warning     the simulation diverged at step "), HasSubstr("\nvalid, with ")));
}

TEST_F(CommandLine, ValidateCountsItsWarnings) {
  json scene = cloth_scene();
  scene["bodies"]["cloth"].erase("springs");
  scene["air"] = {{"wind", {1, 0, 0}}};
  const Ending ending = run({"validate", save(scene)});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(HasSubstr("warning     body \"cloth\": no springs"),
                                HasSubstr("warning     body \"cloth\": air.wind has no effect"),
                                HasSubstr("\nvalid, with 2 warnings\n"), Not(HasSubstr("no errors"))));
}

// A step at which four passes cannot hold a cloth that hangs by two corners.
TEST_F(CommandLine, ReportsTheSolverOfTheStretchLimitAndItsHandover) {
  json scene = cloth_scene();
  scene["step"] = 1.0 / 120.0;
  scene["stretch_limit"] = {{"solver", "auto"}, {"iterations", 4}};
  scene["bodies"]["cloth"]["shape"]["resolution"] = {20, 20};
  scene["bodies"]["cloth"]["springs"] = {{"structural", {{"stiffness", 0}}}};
  scene["bodies"]["cloth"]["place"]["rotation"] = {0, 0, 0};
  scene["bodies"]["cloth"]["pins"] = json::array({{{"at", "corner"}, {"which", {"min_max", "max_max"}}}});
  scene["obstacles"]["ball"]["place"] = {{"position", {0, -9, 0}}};
  EXPECT_THAT(run({"validate", save(scene)}).out,
              HasSubstr("solved by gauss_seidel, then newton for what keeps missing the limit"));
  const Ending ending = run({"run", save(scene), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("gauss_seidel kept missing the stretch limit of body \"cloth\"; newton solves it after step " +
                                    summary()["newton_from"][0]["step"].dump()));
  EXPECT_GT(summary()["limit_solves"], 0);
}

TEST_F(CommandLine, ValidatePrintsDerivedMaterials) {
  json scene = cloth_scene();
  json& cloth = scene["bodies"]["cloth"];
  cloth["shape"] = {{"type", "cloth"}, {"size", {2, 1}}, {"resolution", {5, 3}}};
  cloth.erase("mass");
  cloth["density"] = 0.8;
  cloth["springs"] = {{"structural", {{"modulus", 30}, {"damping", 0.25}}},
                      {"shear", {{"stiffness", 7}, {"damping_ratio", 0.1}}},
                      {"bend", {{"model", "angle"}, {"modulus", 0.4}, {"damping", 0.01}}}};
  const Ending ending = run({"validate", save(scene)});
  EXPECT_EQ(ending.code, 0) << ending.err;
  // Cells of half a metre: 0.8 kg/m^2 * 0.25 m^2 inside, a quarter of it in corners; k_s = modulus, on edges half of it.
  EXPECT_THAT(ending.out,
              AllOf(HasSubstr("1.6 kg, 0.8 kg/m^2, 0.05 to 0.2 kg per particle"),
                    HasSubstr("structural  k_s 15 to 30 N/m, k_d 0.25 N s/m, rest length 0.5 m"),
                    HasSubstr("shear       k_s 7 N/m, k_d 0."), HasSubstr("rest length 0.707107 m"),
                    HasSubstr("bend        14 angles, k 0.2 to 0.4 N m, damping 0.01 N m s, between segments of 0.5 m")));
}

// A rope of 1 m with EA = 1000 N and 0.1 kg hangs by g m L / (2 EA) = 0.49 mm lower and swings as a rod of that length: 1.64 s.
// With EI = 0.1 N m^2 in three inner particles of four segments, its bending length is cbrt(0.75 EI / (g m / L)) = 0.424 m; twice
// that droops by 41 degrees.
TEST_F(CommandLine, ValidateEstimatesHowStiffABodyIs) {
  json scene = rope_scene();
  scene["bodies"]["rope"]["springs"] = json::parse(R"({"structural": {"modulus": 1000}})");
  const std::string text = run({"validate", save(scene)}).out;
  EXPECT_THAT(text, HasSubstr("1 m long: sinks by 0.00049 m under its weight, swings in 1.6 s, bounces in 0.04 s\n"));
  EXPECT_THAT(text, Not(HasSubstr("droops")));
  scene["bodies"]["rope"]["springs"] =
      json::parse(R"({"structural": {"modulus": 1000}, "bend": {"model": "angle", "modulus": 0.1}})");
  EXPECT_THAT(run({"validate", save(scene)}).out, HasSubstr("an overhang of 0.85 m droops by 41 degrees\n"));
  scene["bodies"]["rope"]["springs"] = json::parse(R"({"structural": {"stiffness": 0}})");
  EXPECT_THAT(run({"validate", save(scene)}).out, HasSubstr("nothing holds its length, swings in 1.6 s\n"));
  scene["stretch_limit"] = {{"max_stretch", 0.05}};
  EXPECT_THAT(run({"validate", save(scene)}).out, HasSubstr("sinks by 0.05 m under its weight, held by the stretch limit"));
}

// The limit of a material leaves out springs that break, and the user can change nothing about that.
TEST_F(CommandLine, APresetThatMayTearGetsNoAdviceOnAStretchLimit) {
  json scene = rope_scene();
  scene["bodies"]["rope"].erase("mass");
  scene["bodies"]["rope"]["material"] = "hemp";
  scene["bodies"]["rope"]["springs"] = json::parse(R"({"structural": {"break": 0.1}})");
  const Ending ending = run({"validate", save(scene)});
  EXPECT_THAT(ending.out, HasSubstr("the scene has no errors\n"));
  EXPECT_THAT(ending.out, Not(HasSubstr("warning")));
  EXPECT_THAT(ending.out, Not(HasSubstr("held by the stretch limit")));
}

TEST_F(CommandLine, MaterialsListsAllOrDescribesOne) {
  const Ending all = run({"materials"});
  EXPECT_EQ(all.code, 0);
  EXPECT_THAT(all.out, AllOf(HasSubstr("\ncotton "), HasSubstr("\nsteel_cable "), HasSubstr("\nsoft_jelly ")));
  EXPECT_THAT(run({"materials", "cotton"}).out, HasSubstr("density = 0.1238 kg/m^2\n    published: "));
  const Ending unknown = run({"materials", "coton"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("sprung: error: there is no material coton; did you mean \"cotton\"?\n"));
  EXPECT_THAT(run({"materials", "jelly"}).err, HasSubstr("did you mean \"soft_jelly\" or \"firm_jelly\"?\n"));
  for (const char* kind : {"rope", "ropes"}) {
    const Ending ropes = run({"materials", kind});
    EXPECT_EQ(ropes.code, 0);
    EXPECT_THAT(ropes.out, AllOf(HasSubstr("\nhemp "), HasSubstr("\nsteel_cable "), Not(HasSubstr("cotton"))));
  }
}

TEST_F(CommandLine, InfoDescribesAMeshAsObstacleAndAsBody) {
  const Ending ending = run({"info", SPRUNG_SOURCE_DIR "/meshes/stairs.obj"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.err, "");
  EXPECT_THAT(ending.out, AllOf(HasSubstr("closed"), HasSubstr("components  1"), HasSubstr("as a body"), HasSubstr("size")));
}

// The corner of a cube of side 2: its edges are 2 and 2 sqrt(2) m long, and it has a sixth of the cube's volume.
TEST_F(CommandLine, InfoDescribesTetrahedra) {
  write_text(scratch_ / "corner.node", "4 3 0 0\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n");
  write_text(scratch_ / "corner.ele", "1 4 0\n1 1 2 3 4\n");
  for (const char* name : {"corner.node", "corner.ele"}) {
    const Ending ending = run({"info", (scratch_ / name).string()});
    EXPECT_EQ(ending.code, 0) << ending.err;
    EXPECT_THAT(ending.out, AllOf(StartsWith("as a body of type \"tetrahedra\""), HasSubstr("particles   4\n"),
                                  HasSubstr("size        2 x 2 x 2 m, from (0, 0, 0) to (2, 2, 2)\n"), HasSubstr("tetrahedra  1\n"),
                                  HasSubstr("volume      1.333 m^3\n"), HasSubstr("edges       6, 2 to 2.828 m long\n"),
                                  HasSubstr("surface     4 triangles\n")));
  }
}

TEST_F(CommandLine, InfoFindsMeshesAsScenesDo) {
  const std::string meshes = SPRUNG_SOURCE_DIR "/meshes";
  const Ending missing = run({"info", "torus.ply", "--mesh-path", scratch_.path().string()});
  EXPECT_EQ(missing.code, 3);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("no such file: looked for torus.ply, " + (scratch_ / "torus.ply").string()),
                                 HasSubstr("name its folder with --mesh-path")));
  EXPECT_EQ(run({"info", "torus.ply", "--mesh-path", meshes}).code, 0);
  EXPECT_EQ(Program({"info", "torus.ply"}, {.mesh_path = meshes}).wait().code, 0);
}

TEST_F(CommandLine, ValidateDescribesDeformingObstacles) {
  json scene = rope_scene();
  write_text(scratch_ / "lung.1.obj", "v 0 -50 0\nv 1 -50 0\nv 0 -50 1\nf 1 3 2\n");
  write_text(scratch_ / "lung.2.obj", "v 0 -50 0\nv 2 -50 0\nv 0 -50 1\nf 1 3 2\n");
  scene["obstacles"]["lung"]["shape"] = {{"type", "sequence"}, {"files", "lung.*.obj"}, {"frame_rate", 25}, {"loop", true}};
  const Ending ending = run({"validate", save(scene)});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(HasSubstr("lung: sequence of 2 frames, 25 per second from 0 s, looped, deforming"),
                                HasSubstr("lung.1.obj and 1 more, 1 triangle read, open")));
  EXPECT_THAT(listing(scratch_.path()), ::testing::Not(Contains("lung/")));
  EXPECT_EQ(run({"run", save(scene), "--frames", "2", "--out", out()}).code, 0);
  EXPECT_THAT(listing(out()), Contains("obstacles/lung/lung.0002.obj"));
}

TEST_F(CommandLine, InfoOfSeveralMeshesReportsWhetherTheyAreFrames) {
  const std::string a = (scratch_ / "a.obj").string();
  const std::string b = (scratch_ / "b.obj").string();
  write_text(a, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write_text(b, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Ending ending = run({"info", a, b});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out,
              AllOf(HasSubstr("frames      2"), HasSubstr("moves 2 m"), HasSubstr("0.1667 to 0.5 m^3"), HasSubstr("closed")));
  const Ending other = run({"info", a, SPRUNG_SOURCE_DIR "/meshes/stairs.obj"});
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("must be equally many as in a.obj"));
}

TEST_F(CommandLine, InfoOfARopeReportsThatItIsNoObstacle) {
  write_text(scratch_ / "rope.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nl 1 2 3\n");
  const Ending ending = run({"info", (scratch_ / "rope.obj").string()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(HasSubstr("not an obstacle"), HasSubstr("particles   3"), HasSubstr("lines       2")));
}

TEST_F(CommandLine, MoreFramesThanASceneMayHaveAreRefused) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--frames", "10000001"});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, AllOf(HasSubstr("--frames"), HasSubstr("10000000")));
}

TEST_F(CommandLine, HelpAndVersionGoToStandardOutput) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--help"}, {"help"}, {"run", "--help"}, {"help", "run"}, {"--version"}}) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.code, 0);
    EXPECT_EQ(ending.err, "");
    EXPECT_NE(ending.out, "");
  }
  EXPECT_THAT(run({"--help"}).out, AllOf(HasSubstr("Examples:"), HasSubstr("sprung run "), HasSubstr("Exit codes:")));
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_THAT(run({"run", "--help"}).out, HasSubstr("--overwrite"));
  EXPECT_EQ(run({"help", "run"}).out, run({"run", "--help"}).out);
  EXPECT_THAT(run({"--version"}).out, ::testing::MatchesRegex("sprung [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CommandLine, MeshesAreFoundByOptionAndEnvironment) {
  json scene = rope_scene();
  scene["obstacles"]["torus"] = {{"shape", {{"type", "mesh"}, {"file", "torus.ply"}}}, {"place", {{"position", {0, -50, 0}}}}};
  const std::string file = save(scene);
  const std::string meshes = SPRUNG_SOURCE_DIR "/meshes";
  EXPECT_EQ(run({"validate", file}).code, 3);
  EXPECT_EQ(run({"validate", file, "--mesh-path", scratch_.path().string(), "--mesh-path", meshes}).code, 0);
  EXPECT_EQ(Program({"validate", file}, {.mesh_path = "/nowhere:" + meshes}).wait().code, 0);
}

}  // namespace
}  // namespace sprung
