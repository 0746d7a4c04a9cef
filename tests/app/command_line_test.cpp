// The program from outside: what it accepts, how it ends, what it says where, and what it leaves behind.
#include "app/program.h"
#include "output/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace sprung {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::Ending;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::listing;
using ::testing::Not;
using testing::Program;
using testing::read_text;
using testing::ScratchFolder;
using ::testing::StartsWith;
using testing::write_text;

constexpr auto kPatience = std::chrono::seconds(30);

/// A rope of 5 particles that swings for 0.2 s: 7 frames.
json rope_scene() {
  return json::parse(R"({
    "duration": 0.2,
    "bodies": {
      "rope": {
        "shape": { "type": "rope", "from": [0, 2, 0], "to": [1, 2, 0], "particles": 5 },
        "mass": 0.1,
        "springs": { "structural": { "stiffness": 100, "damping": 0.01 } },
        "pins": [ { "indices": [0] } ]
      }
    }
  })");
}

/// A cloth of 70 x 70 that falls on a ball: more particles than one chunk of any parallel loop.
json cloth_scene() {
  return json::parse(R"({
    "duration": 0.2,
    "bodies": {
      "cloth": {
        "shape": { "type": "cloth", "size": [1, 1], "resolution": [70, 70] },
        "mass": 0.2,
        "springs": { "structural": { "stiffness": 200, "damping": 0.01 }, "shear": { "stiffness": 100, "damping": 0.01 } },
        "place": { "position": [0, 0.31, 0], "rotation": [90, 0, 0] },
        "thickness": 0.005, "friction": 0.3
      }
    },
    "obstacles": { "ball": { "shape": { "type": "sphere", "radius": 0.3 } } }
  })");
}

/// Two masses on a spring that is far too stiff for the step.
json diverging_scene() {
  json scene = rope_scene();
  scene["duration"] = 10.0;
  scene["step"] = 1.0 / 30.0;
  scene["bodies"]["rope"]["springs"]["structural"] = {{"stiffness", 1e6}, {"damping", 0.0}};
  return scene;
}

class CommandLine : public ::testing::Test {
 protected:
  std::string save(const json& scene, const std::string& name = "scene.json") const {
    write_text(scratch_ / name, scene.dump(2));
    return (scratch_ / name).string();
  }
  [[nodiscard]] std::string out(const std::string& name = "out") const { return (scratch_ / name).string(); }
  [[nodiscard]] json record() const { return json::parse(read_text(scratch_ / "out/run.json")); }
  [[nodiscard]] bool wrote_something() const { return std::filesystem::exists(out()); }

  static Ending run(const std::vector<std::string>& arguments) { return Program(arguments).wait(); }

  static bool wait_for(const std::filesystem::path& file) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (std::filesystem::exists(file)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  ScratchFolder scratch_;
};

TEST_F(CommandLine, RunWritesTheFramesAndSaysSoOnStandardErrorOnly) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.out, "");
  EXPECT_THAT(ending.err, HasSubstr("7 frames"));
  EXPECT_THAT(ending.err, HasSubstr("frame 7/7"));
  EXPECT_THAT(listing(out()),
              ElementsAre("diagnostics.csv", "rope/", "rope/rope.0001.obj", "rope/rope.0002.obj", "rope/rope.0003.obj",
                          "rope/rope.0004.obj", "rope/rope.0005.obj", "rope/rope.0006.obj", "rope/rope.0007.obj", "run.json"));
  EXPECT_EQ(record()["outcome"], "done");
  EXPECT_EQ(record()["frames_written"], 7);
  EXPECT_EQ(record()["scene"]["bodies"]["rope"]["mass"], 0.1);
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
  EXPECT_THAT(shown, AllOf(HasSubstr("\r[####"), HasSubstr("frame 1/7"), HasSubstr("ms a frame"), HasSubstr("left"),
                           HasSubstr("[##############################] frame 7/7")));
}

TEST_F(CommandLine, SetReplacesValuesAndFramesTheDuration) {
  const Ending ending = run({"run", "--set", "bodies.rope.mass=0.25", "--set", "bodies.rope.shape.particles=9", save(rope_scene()),
                             "--frames", "2", "--out", out()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(record()["frames"], 2);
  EXPECT_EQ(record()["scene"]["bodies"]["rope"]["mass"], 0.25);
  EXPECT_THAT(read_text(scratch_ / "out/rope/rope.0002.obj"), HasSubstr("l 1 2 3 4 5 6 7 8 9"));
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

TEST_F(CommandLine, ValidatePrintsWhatFollowsFromTheScene) {
  const Ending ending = run({"validate", save(cloth_scene())});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.err, "");
  EXPECT_THAT(ending.out, AllOf(HasSubstr("4900 particles"), HasSubstr("9660 structural"), HasSubstr("9522 shear"),
                                HasSubstr("7 at 30 a second"), HasSubstr("(automatic)"), HasSubstr("largest stable step"),
                                HasSubstr("ball: sphere")));
}

TEST_F(CommandLine, InfoDescribesAMeshAsObstacleAndAsBody) {
  const Ending ending = run({"info", SPRUNG_SOURCE_DIR "/meshes/stairs.obj"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.err, "");
  EXPECT_THAT(ending.out, AllOf(HasSubstr("closed"), HasSubstr("components  1"), HasSubstr("as a body"), HasSubstr("size")));
}

TEST_F(CommandLine, InfoOfARopeTellsThatItIsNoObstacle) {
  write_text(scratch_ / "rope.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nl 1 2 3\n");
  const Ending ending = run({"info", (scratch_ / "rope.obj").string()});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(HasSubstr("not an obstacle"), HasSubstr("particles   3"), HasSubstr("lines       2")));
}

TEST_F(CommandLine, HelpAndVersionGoToStandardOutput) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--help"}, {"run", "--help"}, {"--version"}}) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.code, 0);
    EXPECT_EQ(ending.err, "");
    EXPECT_NE(ending.out, "");
  }
  EXPECT_THAT(run({"--help"}).out, AllOf(HasSubstr("Examples:"), HasSubstr("sprung run "), HasSubstr("Exit codes:")));
  EXPECT_THAT(run({"run", "--help"}).out, HasSubstr("--overwrite"));
  EXPECT_THAT(run({"--version"}).out, ::testing::MatchesRegex("sprung [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CommandLine, WrongUsageEndsWithTwoAndSuggests) {
  const std::string scene = save(rope_scene());
  const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.code, 2) << text;
    EXPECT_EQ(ending.out, "");
    EXPECT_THAT(ending.err, AllOf(StartsWith("sprung: error: "), HasSubstr(text), HasSubstr("--help")));
    EXPECT_FALSE(wrote_something());
  };
  refused({}, "subcommand");
  refused({"rum", scene}, "did you mean run?");
  refused({"run", scene}, "--out");
  refused({"run", "--out", out()}, "SCENE");
  refused({"run", scene, "--out", out(), "--overwite"}, "did you mean --overwrite?");
  refused({"run", scene, "other.json", "--out", out()}, "other.json");
  refused({"run", scene, "--out", out(), "--frames", "0"}, "--frames");
  refused({"run", scene, "--out", out(), "--frames", "many"}, "--frames");
  refused({"run", scene, "--out", out(), "--threads", "-1"}, "--threads");
}

TEST_F(CommandLine, InvalidSceneEndsWithThreeNamesEveryProblemAndWritesNothing) {
  json scene = rope_scene();
  scene["bodies"]["rope"]["mass"] = -1.0;
  scene["bodies"]["rope"]["springs"]["structural"]["stifness"] = 3;
  const std::string file = save(scene);
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run", file, "--out", out()}, {"validate", file}}) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.code, 3);
    EXPECT_EQ(ending.out, "");
    EXPECT_THAT(ending.err, AllOf(HasSubstr("bodies.rope.mass = -1"), HasSubstr("stifness"), HasSubstr("stiffness")));
    std::istringstream lines(ending.err);
    for (std::string line; std::getline(lines, line);) EXPECT_THAT(line, StartsWith("sprung: error: " + file));
    EXPECT_FALSE(wrote_something());
  }
}

TEST_F(CommandLine, MeshThatIsMissingOrBrokenEndsWithThree) {
  json scene = rope_scene();
  scene["obstacles"]["thing"]["shape"] = {{"type", "mesh"}, {"file", "thing.obj"}};
  const std::string file = save(scene);
  EXPECT_EQ(run({"run", file, "--out", out()}).code, 3);
  write_text(scratch_ / "thing.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  const Ending broken = run({"run", file, "--out", out()});
  EXPECT_EQ(broken.code, 3);
  EXPECT_THAT(broken.err, HasSubstr("thing.obj"));
  EXPECT_FALSE(wrote_something());
  EXPECT_EQ(run({"info", (scratch_ / "thing.obj").string()}).code, 3);
  EXPECT_EQ(run({"info", (scratch_ / "missing.obj").string()}).code, 3);
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

TEST_F(CommandLine, StepThatIsTooLargeIsRefusedBeforeAnythingIsWritten) {
  const Ending ending = run({"run", save(diverging_scene()), "--out", out()});
  EXPECT_EQ(ending.code, 3);
  EXPECT_THAT(ending.err, HasSubstr("stable"));
  EXPECT_FALSE(wrote_something());
}

TEST_F(CommandLine, DivergenceEndsWithFourAndKeepsTheGoodFrames) {
  const Ending ending = run({"run", save(diverging_scene()), "--out", out(), "--set", "stability=\"warn\""});
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(ending.err, AllOf(HasSubstr("warning"), HasSubstr("diverged at step"), HasSubstr("time"), HasSubstr("body \"rope\""),
                                HasSubstr("particle"), HasSubstr("spring")));
  EXPECT_THAT(record()["outcome"].get<std::string>(), StartsWith("diverged: "));
  const int frames = record()["frames_written"];
  EXPECT_GE(frames, 1);
  const std::string rows = read_text(scratch_ / "out/diagnostics.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), frames + 1);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), static_cast<std::size_t>(frames));
  EXPECT_THAT(read_text(scratch_ / ("out/rope/" + listing(scratch_ / "out/rope").back())), Not(HasSubstr("n")));
}

TEST_F(CommandLine, SceneThatCannotBeReadEndsWithFive) {
  for (const std::string& scene : {out("missing.json"), scratch_.path().string(), out("a\nb")}) {
    const Ending ending = run({"run", scene, "--out", out()});
    EXPECT_EQ(ending.code, 5) << ending.err;
    EXPECT_FALSE(wrote_something());
  }
}

TEST_F(CommandLine, OutputThatCannotBeWrittenEndsWithFive) {
  const std::string scene = save(rope_scene());
  for (const std::string& folder : {scene, scene + "/below", std::string("/proc/nothing/here"), std::string()}) {
    const Ending ending = run({"run", scene, "--out", folder});
    EXPECT_EQ(ending.code, 5) << folder;
    EXPECT_THAT(ending.err, StartsWith("sprung: error: "));
  }
  EXPECT_THAT(listing(scratch_.path()), ElementsAre("scene.json"));
}

TEST_F(CommandLine, FullDiskEndsWithFiveAndLeavesNoHalfFrame) {
  // run.json takes about 2 kB and fits, a frame of 70 x 70 particles does not.
  const Ending ending = Program({"run", save(cloth_scene()), "--out", out()}, {.file_size = 20'000}).wait();
  EXPECT_EQ(ending.code, 5) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("/cloth.0001.obj: cannot write"));
  EXPECT_THAT(listing(out()), ElementsAre("diagnostics.csv", "run.json"));
  EXPECT_EQ(record()["frames_written"], 0);
  EXPECT_THAT(record()["outcome"].get<std::string>(), StartsWith("failed: "));
}

TEST_F(CommandLine, ResultThatCannotBePrintedEndsWithFive) {
  EXPECT_EQ(Program({"--help"}, {.output = "/dev/full"}).wait().code, 5);
}

TEST_F(CommandLine, FolderThatIsNotEmptyIsOverwrittenOnlyWhenAsked) {
  const std::string scene = save(rope_scene());
  ASSERT_EQ(run({"run", scene, "--out", out(), "--quiet"}).code, 0);
  write_text(scratch_ / "out/rope/notes.txt", "mine");
  const std::vector<std::string> before = listing(out());

  const Ending refused = run({"run", scene, "--out", out()});
  EXPECT_EQ(refused.code, 5);
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_EQ(listing(out()), before);

  EXPECT_EQ(run({"run", scene, "--out", out(), "--overwrite", "--frames", "1"}).code, 0);
  EXPECT_THAT(listing(out()), ElementsAre("diagnostics.csv", "rope/", "rope/notes.txt", "rope/rope.0001.obj", "run.json"));
}

TEST_F(CommandLine, InvalidSceneDoesNotOverwrite) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out()}).code, 0);
  const std::vector<std::string> before = listing(out());
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out(), "--overwrite", "--set", "bodies.rope.mass=0"}).code, 3);
  EXPECT_EQ(listing(out()), before);
}

class Interrupted : public CommandLine, public ::testing::WithParamInterface<int> {};

TEST_P(Interrupted, RunFinishesItsFrameAndKeepsAll) {
  Program program({"run", save(rope_scene()), "--out", out(), "--frames", "1000000"});
  ASSERT_TRUE(wait_for(scratch_ / "out/rope/rope.0000020.obj"));
  program.send(GetParam());
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 130) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("interrupted"));
  EXPECT_EQ(record()["outcome"], "interrupted");
  const std::size_t frames = record()["frames_written"];
  EXPECT_GE(frames, 20U);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), frames);
  const std::string rows = read_text(scratch_ / "out/diagnostics.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')), frames + 1);
}

INSTANTIATE_TEST_SUITE_P(BySignal, Interrupted, ::testing::Values(SIGINT, SIGTERM));

TEST_F(CommandLine, KilledRunCanBeOverwritten) {
  const std::string scene = save(rope_scene());
  {
    Program program({"run", scene, "--out", out(), "--frames", "1000000"});
    ASSERT_TRUE(wait_for(scratch_ / "out/rope/rope.0000020.obj"));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().signal, SIGKILL);
  }
  EXPECT_EQ(record()["outcome"], "running");
  EXPECT_EQ(run({"run", scene, "--out", out(), "--overwrite"}).code, 0);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), 7U);
  EXPECT_EQ(listing(out()).size(), 7U + 3U);
}

}  // namespace
}  // namespace sprung
