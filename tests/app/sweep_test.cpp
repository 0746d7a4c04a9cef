// Sweeps, with the program that users start.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace sprung::testing {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string kStiffness = "bodies.rope.springs.structural.stiffness";

/// A rope whose run takes long enough to be killed in it.
json slow_scene() {
  json scene = rope_scene();
  scene["duration"] = 20.0;
  scene["step"] = 1.0 / 3000.0;
  return scene;
}

class Sweep : public CommandLine {
 protected:
  [[nodiscard]] std::vector<std::string> command(const json& scene, const std::vector<std::string>& options) const {
    std::vector<std::string> words{"sweep", save(scene), "--out", out()};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  [[nodiscard]] Ending sweep(const json& scene, const std::vector<std::string>& options) const {
    return run(command(scene, options));
  }

  [[nodiscard]] json manifest() const { return json::parse(read_text(scratch_ / "out/manifest.json")); }
  [[nodiscard]] std::vector<std::string> statuses() const {
    std::vector<std::string> found;
    const json all = manifest();
    for (const json& run : all["runs"]) found.push_back(run["status"]);
    return found;
  }
  [[nodiscard]] std::vector<std::string> lines_of(const std::string& file) const {
    std::istringstream stream(read_text(scratch_ / file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  /// How often each run ended.
  [[nodiscard]] std::map<int, int> ends() const {
    std::map<int, int> count;
    for (const auto& journal : std::filesystem::directory_iterator(scratch_ / "out/journal")) {
      std::ifstream stream(journal.path());
      for (std::string line; std::getline(stream, line);) {
        if (json::accept(line)) ++count[json::parse(line)["run"]];
      }
    }
    return count;
  }
  /// Whether a run has written a frame.
  [[nodiscard]] bool has_begun(const std::string& run) const {
    return std::filesystem::exists(scratch_ / ("out/runs/" + run + "/diagnostics.csv"));
  }
};

TEST_F(Sweep, RunsEachCombinationAndListsItsResults) {
  const Ending ending = sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.2", "--vary", "gravity=[0,-9.81,0],[0,-1.6,0]"});
  ASSERT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(ending.out, "");
  const json runs = manifest()["runs"];
  ASSERT_THAT(runs, SizeIs(4));
  EXPECT_EQ(runs[2]["values"], json::parse(R"({"bodies.rope.mass": 0.2, "gravity": [0, -9.81, 0]})"));
  EXPECT_EQ(runs[2]["number"], 3);
  EXPECT_EQ(runs[2]["exit_code"], 0);
  EXPECT_GT(runs[2]["seconds"], 0.0);
  EXPECT_THAT(statuses(), Each("done"));
  EXPECT_THAT(listing(out() + "/runs/0004"), ElementsAre("diagnostics.csv", "run.json")) << "no frames";
  const json resolved = json::parse(read_text(scratch_ / "out/runs/0004/run.json"))["scene"];
  EXPECT_EQ(resolved["bodies"]["rope"]["mass"], 0.2);
  EXPECT_EQ(resolved["gravity"][1], -1.6);

  const std::vector<std::string> results = lines_of("out/results.csv");
  ASSERT_THAT(results, SizeIs(5));
  EXPECT_THAT(results[0], StartsWith("number,status,exit_code,seconds,bodies.rope.mass,gravity,frame,time,"));
  EXPECT_THAT(results[0], HasSubstr(",largest_stretch,largest_stretch_excess,wall_seconds"));
  EXPECT_THAT(results[3], AllOf(StartsWith("3,done,0,"), HasSubstr(",0.2,\"[0,-9.81,0]\",7,0.2,")));
}

TEST_F(Sweep, WhatIsDoneIsNotDoneAgain) {
  ASSERT_EQ(sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.2"}).code, 0);
  const std::string results = read_text(scratch_ / "out/results.csv");
  const Ending again = sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.2"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("0 of 2 runs to do"));
  EXPECT_THAT(ends(), ElementsAre(std::pair(1, 1), std::pair(2, 1)));
  EXPECT_EQ(read_text(scratch_ / "out/results.csv"), results);
}

TEST_F(Sweep, SamplesAreThoseOfTheSeed) {
  const std::vector<std::string> options{"--sample", "bodies.rope.mass=uniform(0.1,0.2)", "--count", "3", "--seed", "5"};
  ASSERT_EQ(sweep(rope_scene(), options).code, 0);
  const json first = manifest()["runs"];
  std::filesystem::remove_all(out());
  ASSERT_EQ(sweep(rope_scene(), options).code, 0);
  for (std::size_t run = 0; run < 3; ++run) EXPECT_EQ(manifest()["runs"][run]["values"], first[run]["values"]);
}

TEST_F(Sweep, FramesAreWrittenInTheFormatsThatAreAskedFor) {
  ASSERT_EQ(sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1", "--frames", "2", "--format", "pc2"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(out() + "/runs/0001/rope.pc2"));
}

TEST_F(Sweep, AFailedRunKeepsItsMessageAndIsTriedAgainOnRequestAlone) {
  json scene = rope_scene();
  scene["step"] = 1.0 / 240.0;
  const std::vector<std::string> options{"--vary", kStiffness + "=1e9,100,200"};
  const Ending ending = sweep(scene, options);
  EXPECT_EQ(ending.code, 4);
  EXPECT_THAT(ending.err, HasSubstr("run 0001: "));
  EXPECT_THAT(statuses(), ElementsAre("failed", "done", "done"));
  EXPECT_EQ(manifest()["runs"][0]["exit_code"], 3);
  EXPECT_THAT(manifest()["runs"][0]["message"], HasSubstr("is beyond the largest stable step"));
  EXPECT_THAT(lines_of("out/results.csv")[1], StartsWith("1,failed,3,"));

  EXPECT_EQ(sweep(scene, options).code, 4);
  EXPECT_THAT(ends(), ElementsAre(std::pair(1, 1), std::pair(2, 1), std::pair(3, 1)));
  std::vector<std::string> again = options;
  again.push_back("--retry-failed");
  EXPECT_EQ(sweep(scene, again).code, 4);
  EXPECT_THAT(ends(), ElementsAre(std::pair(1, 3), std::pair(2, 1), std::pair(3, 1))) << "forgotten, and failed again";
}

TEST_F(Sweep, OtherValuesOrAnotherSceneAreRefusedWithTheDifference) {
  ASSERT_EQ(sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.2"}).code, 0);
  const std::string before = read_text(scratch_ / "out/manifest.json");
  const Ending values = sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.3"});
  EXPECT_EQ(values.code, 3);
  EXPECT_THAT(values.err,
              HasSubstr(R"(vary[0] = "bodies.rope.mass=0.1,0.3": the sweep in the folder has "bodies.rope.mass=0.1,0.2")"));
  json other = rope_scene();
  other["bodies"]["rope"]["shape"]["particles"] = 6;
  const Ending scene = sweep(other, {"--vary", "bodies.rope.mass=0.1,0.2"});
  EXPECT_EQ(scene.code, 3);
  EXPECT_THAT(scene.err, HasSubstr("scene.bodies.rope.shape.particles = 6: the sweep in the folder has 5; go on with the same"));
  EXPECT_EQ(read_text(scratch_ / "out/manifest.json"), before);
}

TEST_F(Sweep, BadInputIsNamedInOneGoAndNothingIsWritten) {
  const Ending keys = sweep(rope_scene(), {"--vary", "bodies.rope.mas=1,2", "--vary", "bodies.rop.mass=1", "--vary",
                                           "bodies.rope.mass=0.1,-1", "--vary", "frame_rates=30"});
  EXPECT_EQ(keys.code, 3);
  EXPECT_THAT(keys.err, HasSubstr("did you mean \"mass\"?"));
  EXPECT_THAT(keys.err, HasSubstr("did you mean \"rope\"?"));
  EXPECT_THAT(keys.err, HasSubstr("bodies.rope.mass = -1: must be"));
  EXPECT_THAT(keys.err, HasSubstr("did you mean \"frame_rate\"?"));
  EXPECT_THAT(keys.err, Not(HasSubstr("--set")));
  const Ending ranges = sweep(rope_scene(), {"--vary", "gravity=", "--sample", "duration=uniform(2,1)", "--count", "3"});
  EXPECT_EQ(ranges.code, 3);
  EXPECT_THAT(ranges.err,
              AllOf(HasSubstr("--vary = gravity=: the range is empty"), HasSubstr("duration=uniform(2,1): the range is")));
  const Ending samples = sweep(rope_scene(), {"--sample", "bodies.rope.mass=uniform(-2,-1)", "--count", "8", "--seed", "-1"});
  EXPECT_EQ(samples.code, 2);
  EXPECT_THAT(samples.err, HasSubstr("--seed: must be a whole number"));
  const Ending many = sweep(rope_scene(), {"--sample", "bodies.rope.mass=uniform(-2,-1)", "--count", "8", "--set", "a=1"});
  EXPECT_THAT(many.err, AllOf(HasSubstr("changed by --set or --sample: bodies.rope.mass = -1."),
                              HasSubstr("bodies.rope.mass = 3 more values: must be greater than 0")));
  const Ending slurm = Program(command(rope_scene(), {"--vary", "duration=0.1", "--engine", "slurm", "--array-size", "2"}),
                               {.environment = {{"PATH", "/none"}}})
                           .wait();
  EXPECT_EQ(slurm.code, 5);
  EXPECT_THAT(slurm.err, HasSubstr("sbatch is not installed"));
  EXPECT_EQ(sweep(rope_scene(), {"--vary", "duration=0.1", "--engine", "slurm"}).code, 2);
  EXPECT_EQ(run({"sweep", "--status", out()}).code, 3);
  EXPECT_EQ(run({"sweep", "--vary", "a=1"}).code, 2);
  EXPECT_FALSE(wrote_something());
}

TEST_F(Sweep, AMissingMeshIsRefusedBeforeTheSweepBegins) {
  json scene = rope_scene();
  scene["obstacles"]["ball"]["shape"] = {{"type", "mesh"}, {"file", "missing.obj"}};
  EXPECT_EQ(sweep(scene, {"--vary", "bodies.rope.mass=0.1,0.2"}).code, 3);
  EXPECT_FALSE(wrote_something());
}

TEST_F(Sweep, AFolderWithOtherFilesIsRefused) {
  write_text(scratch_ / "out/thesis.txt", "text");
  const Ending ending = sweep(rope_scene(), {"--vary", "bodies.rope.mass=0.1,0.2"});
  EXPECT_EQ(ending.code, 5);
  EXPECT_THAT(ending.err, HasSubstr("it is not empty and has no sweep"));
  EXPECT_THAT(listing(out()), ElementsAre("thesis.txt"));
}

TEST_F(Sweep, AFullDiskEndsWithFiveAndLeavesRunsToDo) {
  const std::vector<std::string> options{"--vary", "bodies.cloth.mass=0.2,0.3", "--frames", "1", "--format", "obj", "--jobs", "1"};
  const Ending manifest_alone = Program(command(cloth_scene(), options), {.file_size = 300}).wait();
  EXPECT_EQ(manifest_alone.code, 5);
  EXPECT_THAT(manifest_alone.err, HasSubstr("manifest.json: cannot write"));
  EXPECT_FALSE(wrote_something());
  // The manifest and run.json fit. The record of a frame of 70 x 70 particles does not.
  const Ending full = Program(command(cloth_scene(), options), {.file_size = 20'000}).wait();
  EXPECT_EQ(full.code, 5) << full.err;
  EXPECT_THAT(full.err, AllOf(HasSubstr("run 0001: "), HasSubstr("cannot write")));
  EXPECT_THAT(statuses(), ElementsAre("pending", "pending"));
  EXPECT_EQ(sweep(cloth_scene(), options).code, 0) << "there is room again";
}

TEST_F(Sweep, AnInterruptedSweepGoesOn) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1,0.2,0.3", "--jobs", "2", "--quiet"};
  Program program(command(slow_scene(), options));
  ASSERT_TRUE(wait_until([&] { return has_begun("0001"); }));
  program.send(SIGINT);
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 130) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("the same command goes on"));
  EXPECT_THAT(statuses(), Each("pending"));
  EXPECT_TRUE(std::filesystem::exists(out() + "/runs/0001/checkpoint.bin"));
  EXPECT_EQ(sweep(slow_scene(), options).code, 0);
  EXPECT_THAT(statuses(), Each("done"));
  EXPECT_THAT(ends(), ElementsAre(std::pair(1, 1), std::pair(2, 1), std::pair(3, 1)));
}

TEST_F(Sweep, AKilledSweepLosesNothingAndDoesNothingTwice) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1,0.2,0.3,0.4,0.5,0.6", "--jobs", "2", "--quiet"};
  for (const char* begun : {"0001", "0003", "0005"}) {
    Program program(command(slow_scene(), options));
    EXPECT_TRUE(wait_until([&] { return has_begun(begun); }));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().signal, SIGKILL);
    EXPECT_THAT(manifest()["runs"], SizeIs(6)) << "the manifest is whole";
  }
  const Ending ending = sweep(slow_scene(), options);
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(statuses(), Each("done"));
  EXPECT_THAT(ends(), AllOf(SizeIs(6), Each(::testing::Pair(::testing::_, 1))));
  EXPECT_THAT(lines_of("out/results.csv"), SizeIs(7));
  EXPECT_THAT(lines_of("out/runs/0001/diagnostics.csv"), SizeIs(1 + 601)) << "a head and each frame once";
}

TEST_F(Sweep, ASceneThatChangesMeanwhileEndsTheSweep) {
  Program program(command(slow_scene(), {"--vary", "bodies.rope.mass=0.1,0.2", "--jobs", "1", "--quiet"}));
  ASSERT_TRUE(wait_until([&] { return has_begun("0001"); }));
  json changed = slow_scene();
  changed["gravity"] = {0, -1, 0};
  (void)save(changed);
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 3) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("scene.gravity[1] = -1: the sweep in the folder has -9.81"));
  (void)save(slow_scene());
  EXPECT_EQ(sweep(slow_scene(), {"--vary", "bodies.rope.mass=0.1,0.2"}).code, 0);
  EXPECT_THAT(statuses(), ElementsAre("done", "done"));
}

TEST_F(Sweep, ASecondDriverIsRefused) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1,0.2", "--quiet"};
  Program program(command(slow_scene(), options));
  ASSERT_TRUE(wait_until([&] { return has_begun("0001"); }));
  const Ending second = sweep(slow_scene(), options);
  EXPECT_EQ(second.code, 5);
  EXPECT_THAT(second.err, HasSubstr("process "));
  const Ending status = run({"sweep", "--status", out()});
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_THAT(status.out, HasSubstr("2: 0 done, 0 failed, "));
}

// As if the driver had been killed between the end of the run and its line.
TEST_F(Sweep, ARunThatIsCompleteIsNotDoneAgain) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1,0.2"};
  ASSERT_EQ(sweep(rope_scene(), options).code, 0);
  const std::string summary = read_text(scratch_ / "out/runs/0002/run.json");
  const std::string results = lines_of("out/results.csv")[2];
  std::filesystem::remove_all(scratch_ / "out/journal");
  ASSERT_EQ(sweep(rope_scene(), options).code, 0);
  EXPECT_EQ(read_text(scratch_ / "out/runs/0002/run.json"), summary);
  const auto from_the_keys = [](const std::string& line) { return line.substr(line.find(",0.2,")); };
  EXPECT_EQ(from_the_keys(lines_of("out/results.csv")[2]), from_the_keys(results));
}

TEST_F(Sweep, ARunWithoutCheckpointsBeginsAgain) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1", "--checkpoint", "0"};
  Program program(command(slow_scene(), options));
  ASSERT_TRUE(wait_until([&] { return has_begun("0001"); }));
  program.send(SIGINT);
  ASSERT_EQ(program.wait().code, 130);
  const Ending again = sweep(slow_scene(), options);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(statuses(), ElementsAre("done"));
}

TEST_F(Sweep, ASceneOfStandardInputIsKept) {
  const std::string text = rope_scene().dump();
  const auto pipe = [&](const std::string& scene) {
    write_text(scratch_ / "input", scene);
    return Program({"sweep", "-", "--vary", "bodies.rope.mass=0.1,0.2", "--out", out()}, {.input = (scratch_ / "input").string()})
        .wait();
  };
  const Ending ending = pipe(text);
  ASSERT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(read_text(scratch_ / "out/scene.json"), text);
  EXPECT_EQ(pipe(text).code, 0) << "it goes on";
  json other = rope_scene();
  other["frame_rate"] = 20;
  const Ending refused = pipe(other.dump());
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("scene.frame_rate = 20: the sweep in the folder has 30"));
  EXPECT_EQ(read_text(scratch_ / "out/scene.json"), text);
}

TEST_F(Sweep, ACrashLosesOneRun) {
  const std::vector<std::string> options{"--vary", "bodies.rope.mass=0.1,0.2", "--jobs", "1", "--quiet"};
  Program program(command(slow_scene(), options));
  const std::string lock = out() + "/runs/0001/.sprung.lock";
  ASSERT_TRUE(wait_until([&] { return has_begun("0001"); }));
  ::kill(std::stoi(read_text(lock)), SIGSEGV);
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 4) << ending.err;
  EXPECT_THAT(statuses(), ElementsAre("failed", "done"));
  EXPECT_THAT(manifest()["runs"][0]["message"], HasSubstr("ended by signal 11"));
}

TEST_F(Sweep, StatusTellsCountsTimeLeftAndFailures) {
  json scene = rope_scene();
  scene["step"] = 1.0 / 240.0;
  ASSERT_EQ(sweep(scene, {"--vary", kStiffness + "=100,1e9,200"}).code, 4);
  const Ending status = run({"sweep", "--status", out()});
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_THAT(status.out, HasSubstr("3: 2 done, 1 failed, 0 running, 0 pending"));
  EXPECT_THAT(status.out, HasSubstr("a run on average"));
  EXPECT_THAT(status.out, HasSubstr("0002: "));
}

TEST_F(Sweep, ADryRunShowsTheScriptAndWritesNothing) {
  const Ending ending = sweep(rope_scene(), {"--vary", "duration=0.1,0.2,0.3", "--engine", "slurm", "--array-size", "2",
                                             "--account", "lab", "--partition", "long", "--time", "1:00:00", "--dry-run"});
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.out, AllOf(StartsWith("#!/bin/sh\n"), HasSubstr("--array=0-1\n"), HasSubstr("--account=lab\n"),
                                HasSubstr("--partition=long\n"), HasSubstr("--time=1:00:00\n")));
  const Ending local = sweep(rope_scene(), {"--vary", "duration=0.1,0.2", "--vary", "gravity=[0,-1,0]", "--dry-run"});
  EXPECT_THAT(local.out, HasSubstr(" --set duration=0.2 --set 'gravity=[0,-1,0]'\n")) << "to be pasted";
  EXPECT_FALSE(wrote_something());
}

/// Stands in for Slurm: sbatch runs the tasks at once, one after the other, and squeue has no job.
class FakeSlurm : public Sweep {
 protected:
  void SetUp() override {
    write_program("sbatch", R"(for script; do :; done
for task in 0 1; do SLURM_ARRAY_TASK_ID=$task sh "$script" || exit 1; done >"$(dirname "$script")/log" 2>&1
echo "17;cluster")");
    write_program("squeue", "echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1");
  }
  [[nodiscard]] Ending submit(const json& scene, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> options{"--vary", kStiffness + "=100,1e9,200", "--engine", "slurm", "--array-size", "2"};
    options.insert(options.end(), more.begin(), more.end());
    return Program(command(scene, options), {.environment = {{"PATH", (scratch_ / "bin").string() + ":/usr/bin:/bin"}}}).wait();
  }

 private:
  void write_program(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = scratch_ / ("bin/" + name);
    write_text(file, "#!/bin/sh\n" + text + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
};

TEST_F(FakeSlurm, TasksDoTheRunsAndStatusTellsHowFarTheyAre) {
  json scene = rope_scene();
  scene["step"] = 1.0 / 240.0;
  const Ending ending = submit(scene);
  EXPECT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(ending.err, HasSubstr("job 17 does "));
  EXPECT_THAT(listing(out() + "/journal"), ElementsAre("task-0.jsonl", "task-1.jsonl"));
  const Ending status = run({"sweep", "--status", out()});
  EXPECT_THAT(status.out, HasSubstr("3: 2 done, 1 failed, 0 running, 0 pending"));
  EXPECT_THAT(statuses(), ElementsAre("done", "failed", "done"));
  EXPECT_THAT(lines_of("out/results.csv"), SizeIs(4));

  const Ending again = submit(scene);
  EXPECT_EQ(again.code, 4);
  EXPECT_THAT(again.err, HasSubstr("nothing is left to do"));
  EXPECT_EQ(submit(scene, {"--retry-failed"}).code, 0);
  EXPECT_THAT(read_text(scratch_ / "out/slurm/sweep.sh"), HasSubstr("--array=1\n")) << "the task of the failed run alone";
}

}  // namespace
}  // namespace sprung::testing
