// How the program ends when it fails, and what it leaves behind.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace sprung {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using testing::cloth_scene;
using testing::CommandLine;
using testing::diverging_scene;
using ::testing::ElementsAre;
using testing::Ending;
using ::testing::HasSubstr;
using testing::listing;
using ::testing::Not;
using testing::Program;
using testing::read_text;
using testing::rope_scene;
using ::testing::StartsWith;
using testing::write_text;

TEST_F(CommandLine, WrongUsageEndsWithTwoAndSuggests) {
  const std::string scene = save(rope_scene());
  const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
    const Ending ending = run(words);
    EXPECT_EQ(ending.code, 2) << text;
    EXPECT_EQ(ending.out, "");
    EXPECT_THAT(ending.err, AllOf(StartsWith("sprung: error: "), HasSubstr(text), HasSubstr("--help")));
    EXPECT_FALSE(wrote_something());
  };
  refused({"--quiet"}, "--quiet");
  refused({"help", "rum"}, "did you mean run?");
  refused({"help", "run", "validate"}, "validate");
  refused({"rum", scene}, "did you mean run?");
  refused({"run", scene}, "--out");
  refused({"run", "--out", out()}, "SCENE");
  refused({"run", scene, "--out", out(), "--overwite"}, "did you mean --overwrite?");
  refused({"run", scene, "other.json", "--out", out()}, "other.json");
  refused({"run", scene, "--out", out(), "--frames", "0"}, "--frames");
  refused({"run", scene, "--out", out(), "--frames", "many"}, "--frames");
  refused({"run", scene, "--out", out(), "--threads", "-1"}, "--threads");
  refused({"export", out()}, "--format is required: choose from html");
  refused({"export", out(), "--format", "fbx"}, "html");
  refused({"export", out(), "--format", "npz,fbx"}, "usda");
}

TEST_F(CommandLine, NoCommandEndsWithTwoAndTheHelpOnStandardError) {
  const Ending ending = run({});
  EXPECT_EQ(ending.code, 2);
  EXPECT_EQ(ending.out, "");
  EXPECT_EQ(ending.err, run({"help"}).out);
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

TEST_F(CommandLine, KeysThatNobodyKnowsHideNothingElse) {
  json scene = rope_scene();
  scene["duraton"] = 1;
  scene["bodies"]["rope"]["pins"] = {{{"indices", {9999}}}};
  scene["obstacles"]["thing"]["shape"] = {{"type", "mesh"}, {"file", "thing.obj"}};
  const Ending ending = run({"validate", save(scene)});
  EXPECT_EQ(ending.code, 3);
  EXPECT_THAT(ending.err,
              AllOf(HasSubstr("duraton: is not a known key"), HasSubstr("bodies.rope.pins[0]"), HasSubstr("thing.obj")));
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
                                HasSubstr("particle"), HasSubstr("spring"), HasSubstr(" %, pulling with "),
                                HasSubstr("use a step of"), HasSubstr("the last frame is "), HasSubstr(" are in " + out())));
  EXPECT_THAT(summary()["outcome"].get<std::string>(), StartsWith("diverged: "));
  const int frames = summary()["frames_written"];
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
  // run.json takes about 2 kB and fits. The start of the record and a frame of 70 x 70 particles do not.
  const std::string scene = save(cloth_scene());
  const Ending with_record = Program({"run", scene, "--out", out("other")}, {.file_size = 20'000}).wait();
  EXPECT_EQ(with_record.code, 5) << with_record.err;
  EXPECT_THAT(with_record.err, HasSubstr("/record.bin: cannot write"));
  EXPECT_THAT(listing(out("other")), ElementsAre());
  const Ending ending = Program({"run", scene, "--out", out(), "--set", "output.record=false"}, {.file_size = 20'000}).wait();
  EXPECT_EQ(ending.code, 5) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("/cloth.0001.obj: cannot write"));
  EXPECT_THAT(listing(out()), ElementsAre("diagnostics.csv", "run.json"));
  EXPECT_EQ(summary()["frames_written"], 0);
  EXPECT_THAT(summary()["outcome"].get<std::string>(), StartsWith("failed: "));
}

// The simulation runs ahead of what is written.
TEST_F(CommandLine, AFullDiskIsToldAlsoIfTheRunDiverges) {
  const Ending ending = Program({"run", save(diverging_scene()), "--out", out(), "--set", "stability=\"warn\"", "--set",
                                 "output.record=false", "--set", "bodies.rope.shape.particles=1000", "--checkpoint", "0"},
                                {.file_size = 20'000})
                            .wait();
  EXPECT_NE(ending.code, 0);
  EXPECT_THAT(ending.err, HasSubstr("/rope.0001.obj: cannot write"));
  EXPECT_EQ(summary()["frames_written"], 0);
  EXPECT_THAT(summary()["outcome"].get<std::string>(), StartsWith("failed: "));
}

TEST_F(CommandLine, RunWithoutFormatAndRecordWritesDiagnosticsAlone) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--format", "none", "--set", "output.record=false"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(listing(out()), ElementsAre("checkpoint.bin", "diagnostics.csv", "run.json"));
}

TEST_F(CommandLine, ResultThatCannotBePrintedEndsWithFive) {
  EXPECT_EQ(Program({"--help"}, {.output = "/dev/full"}).wait().code, 5);
}

TEST_F(CommandLine, AnExportNeverReplacesAPipeOrADevice) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out()}).code, 0);
  const std::filesystem::path pipe = std::filesystem::path(out()) / "pipe.html";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const Ending refused = run({"export", out(), "--format", "html", "--out", pipe.string(), "--overwrite"});
  EXPECT_EQ(refused.code, is_without_viewer(refused) ? 3 : 5);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(CommandLine, AnExportReplacesAFileOnlyWhenAsked) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out()}).code, 0);
  const std::vector<std::string> once{"export", out(), "--format", "html"};
  const Ending exported = run(once);
  if (is_without_viewer(exported)) GTEST_SKIP() << exported.err;
  ASSERT_EQ(exported.code, 0) << exported.err;
  const std::string record = read_text(scratch_ / "out/record.bin");
  const Ending onto_record = run({"export", out(), "--format", "html", "--out", out() + "/record.bin", "--overwrite"});
  EXPECT_EQ(onto_record.code, 5);
  EXPECT_THAT(onto_record.err, HasSubstr("is a file of the run"));
  EXPECT_EQ(read_text(scratch_ / "out/record.bin"), record);
  const Ending refused = run(once);
  EXPECT_EQ(refused.code, 5);
  EXPECT_THAT(refused.err, HasSubstr("it exists; replace it with --overwrite"));
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
  EXPECT_THAT(listing(out()), ElementsAre("checkpoint.bin", "diagnostics.csv", "record.bin", "rope/", "rope/notes.txt",
                                          "rope/rope.0001.obj", "run.json"));
}

TEST_F(CommandLine, InvalidSceneDoesNotOverwrite) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out()}).code, 0);
  const std::vector<std::string> before = listing(out());
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out(), "--overwrite", "--set", "bodies.rope.mass=0"}).code, 3);
  EXPECT_EQ(listing(out()), before);
}

class Interrupted : public CommandLine, public ::testing::WithParamInterface<int> {};

TEST_P(Interrupted, RunLeavesOffAndKeepsAllWholeFrames) {
  Program program({"run", save(rope_scene()), "--out", out(), "--frames", "1000000"});
  ASSERT_TRUE(wait_for(scratch_ / "out/rope/rope.0000020.obj"));
  program.send(GetParam());
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 130) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("interrupted"));
  EXPECT_EQ(summary()["outcome"], "interrupted");
  const std::size_t frames = summary()["frames_written"];
  EXPECT_GE(frames, 20U);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), frames);
  const std::string rows = read_text(scratch_ / "out/diagnostics.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')), frames + 1);
}

// A frame of a hundred million steps takes minutes.
TEST_P(Interrupted, RunWaitsForItsFrameForSecondsOnly) {
  json scene = rope_scene();
  scene["step"] = 1.0 / 30.0e8;
  Program program({"run", save(scene), "--out", out()});
  ASSERT_TRUE(wait_for(scratch_ / "out/rope/rope.0001.obj"));
  program.send(GetParam());
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 130) << ending.err;
  EXPECT_EQ(summary()["frames_written"], 1);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "out/checkpoint.bin")) << "of the first frame";
}

INSTANTIATE_TEST_SUITE_P(BySignal, Interrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST_F(CommandLine, KilledRunCanBeOverwritten) {
  const std::string scene = save(rope_scene());
  {
    Program program({"run", scene, "--out", out(), "--frames", "1000000"});
    ASSERT_TRUE(wait_for(scratch_ / "out/rope/rope.0000020.obj"));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().signal, SIGKILL);
  }
  EXPECT_EQ(summary()["outcome"], "running");
  EXPECT_EQ(run({"run", scene, "--out", out(), "--overwrite"}).code, 0);
  EXPECT_EQ(listing(scratch_ / "out/rope").size(), 7U);
  EXPECT_EQ(listing(out()).size(), 7U + 5U);
}

}  // namespace
}  // namespace sprung
