#include "sweep/sweep_folder.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "sweep/slurm.h"
#include "sweep/sweep_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sprung {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::read_text;
using testing::ScratchFolder;
using testing::write_text;

SweepSettings settings() {
  return {.scene = {.file = "/scenes/rope.json"},
          .request = {.vary = {"mass=0.1,0.2", "name=[1,2],word"}},
          .first_scene = R"({"mass": 0.1, "list": [1, 2]})"};
}

RunState done(double seconds, const std::string& row) {
  return {.status = RunStatus::done, .exit_code = 0, .seconds = seconds, .columns = "frame,reason", .row = row};
}

json manifest_of(const SweepFolder& sweep) { return json::parse(read_text(sweep.path() / kManifestFile)); }

std::string difference(const std::filesystem::path& folder, const SweepSettings& other) {
  try {
    SweepFolder(folder, other).check_is_same_or_free();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SweepFolder, ManifestListsEachRunWithItsValuesAndHowItEnded) {
  const ScratchFolder scratch;
  SweepFolder sweep(scratch.path(), settings());
  sweep.note(2, done(0.5, "7,"));
  sweep.note(3, {.status = RunStatus::failed, .exit_code = 3, .seconds = 0.1, .message = "too stiff"});
  sweep.mark_running(4);
  sweep.write_manifest();
  const json runs = manifest_of(sweep)["runs"];
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0], json::parse(R"({"number": 1, "values": {"mass": 0.1, "name": [1, 2]}, "status": "pending",
                                    "exit_code": null, "seconds": null})"));
  EXPECT_EQ(runs[1], json::parse(R"({"number": 2, "values": {"mass": 0.1, "name": "word"}, "status": "done",
                                    "exit_code": 0, "seconds": 0.5})"));
  EXPECT_EQ(runs[2]["message"], "too stiff");
  EXPECT_EQ(runs[3]["status"], "running");
}

TEST(SweepFolder, IsReadBackAsItWasWritten) {
  const ScratchFolder scratch;
  SweepFolder sweep(scratch.path(), settings());
  sweep.progress() = {.jobs = 3, .checkpoint = 5.0, .job = "17"};
  sweep.note(1, done(0.25, "7,first"));
  sweep.write_manifest();
  const SweepFolder read(scratch.path());
  EXPECT_EQ(read.plan().run_count(), 4);
  EXPECT_EQ(read.progress().jobs, 3);
  EXPECT_EQ(read.progress().job, "17");
  EXPECT_EQ(read.state(1).row, "7,first");
  EXPECT_THAT(runs_to_do(read), ElementsAre(2, 3, 4));
  EXPECT_EQ(read.counts().done, 1);
  EXPECT_DOUBLE_EQ(seconds_left(read.counts(), 3), 0.25);
  EXPECT_EQ(difference(scratch.path(), settings()), "");
}

TEST(SweepFolder, ALineThatWasCutIsLeftOutAndTheNextIsWhole) {
  const ScratchFolder scratch;
  {
    SweepFolder sweep(scratch.path(), settings());
    sweep.write_manifest();
    sweep.note(1, done(0.1, "1,"));
    sweep.note(2, done(0.1, "2,"));
  }
  const std::filesystem::path journal = scratch / "journal/task-0.jsonl";
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) - 9);
  {
    SweepFolder sweep(scratch.path());
    EXPECT_THAT(runs_to_do(sweep), ElementsAre(2, 3, 4));
    sweep.note(3, done(0.1, "3,"));
  }
  EXPECT_THAT(runs_to_do(SweepFolder(scratch.path())), ElementsAre(2, 4));
  write_text(journal, read_text(journal) + "[2]\n{\"run\": \"four\"}\n{\"run\": 99, \"status\": \"done\"}\n");
  EXPECT_THAT(runs_to_do(SweepFolder(scratch.path())), ElementsAre(2, 4)) << "of others";
}

TEST(SweepFolder, OtherSettingsAreRefusedWithTheDifference) {
  const ScratchFolder scratch;
  SweepFolder(scratch.path(), settings()).write_manifest();
  SweepSettings other = settings();
  other.first_scene = R"({"mass": 0.1, "list": [1, 3], "new": true})";
  const std::string text = difference(scratch.path(), other);
  EXPECT_THAT(text, HasSubstr("scene.list[1] = 3: the sweep in the folder has 2; go on with the same values, or choose"));
  EXPECT_THAT(text, HasSubstr("scene.new = true: the sweep in the folder has none"));
  EXPECT_THAT(text, Not(HasSubstr("scene.mass")));
  other.request.vary[0] = "mass=0.1,0.3";
  const std::string of_values = difference(scratch.path(), other);
  EXPECT_THAT(of_values, HasSubstr(R"(vary[0] = "mass=0.1,0.3": the sweep in the folder has "mass=0.1,0.2")"));
  EXPECT_THAT(of_values, Not(HasSubstr("scene."))) << "that is explained by the values";
}

TEST(SweepFolder, AFolderWithOtherFilesIsRefused) {
  const ScratchFolder scratch;
  write_text(scratch / "thesis.txt", "text");
  EXPECT_THROW(SweepFolder(scratch.path(), settings()).check_is_same_or_free(), FileError);
  EXPECT_NO_THROW(SweepFolder(scratch / "new", settings()).check_is_same_or_free());
  EXPECT_THROW(SweepFolder{scratch.path()}, InputError);
}

TEST(SweepFolder, ResultsHaveALineForEachRunThatEnded) {
  const ScratchFolder scratch;
  SweepFolder sweep(scratch.path(), settings());
  sweep.note(1, done(0.5, "7,wake"));
  RunState other = done(0.25, "0.1,8");
  other.columns = "new,frame";
  sweep.note(3, other);
  sweep.note(4, {.status = RunStatus::failed, .exit_code = 4, .seconds = 1.0});
  sweep.write_results();
  EXPECT_EQ(read_text(scratch / kResultsFile),
            "number,status,exit_code,seconds,mass,name,frame,reason,new\n"
            "1,done,0,0.5,0.1,\"[1,2]\",7,wake,\n"
            "3,done,0,0.25,0.2,\"[1,2]\",8,,0.1\n"
            "4,failed,4,1,0.2,word,,,\n");
}

TEST(SweepFolder, ResultOfARunIsItsLastRowAndTheLargestStretch) {
  const ScratchFolder scratch;
  write_text(scratch / "diagnostics.csv", "frame,max_stretch,contacts,stretch_excess\n1,-1,0,0.2\n2,0.5,3,0\n3,0.1,,0\n");
  write_text(scratch / "run.json", R"({"wall_seconds": 1.5})");
  const RunResult result = result_of_run(scratch.path());
  EXPECT_EQ(result.columns, "frame,max_stretch,contacts,stretch_excess,largest_stretch,largest_stretch_excess,wall_seconds");
  EXPECT_EQ(result.row, "3,0.1,,0,0.5,0.2,1.5");
  EXPECT_EQ(result_of_run(scratch / "none").row, "");
}

TEST(Sweep, ARunIsACommandOfItsOwn) {
  const ScratchFolder scratch;
  SweepSettings of_obj = settings();
  of_obj.frames = 5;
  of_obj.scene.overrides = {"gravity=[0,0,0]"};
  EXPECT_THAT(command_of(SweepFolder(scratch.path(), of_obj), 3, "sprung"),
              ElementsAre("sprung", "run", "/scenes/rope.json", "--out", (scratch / "runs/0003").string(), "--overwrite", "--quiet",
                          "--threads", "1", "--format", "none", "--checkpoint", "60", "--frames", "5", "--set",
                          "output.record=false", "--set", "gravity=[0,0,0]", "--set", "mass=0.2", "--set", "name=[1,2]"));
  of_obj.formats = {"obj", "npz"};
  EXPECT_THAT(command_of(SweepFolder(scratch.path(), of_obj), 1, "sprung"),
              AllOf(IsSupersetOf({"obj,npz"}), Not(IsSupersetOf({"output.record=false"}))));
}

TEST(Sweep, ARunWithACheckpointOrAllFramesGoesOn) {
  const ScratchFolder scratch;
  const SweepFolder sweep(scratch.path(), settings());
  write_text(scratch / "runs/0001/checkpoint.bin", "");
  write_text(scratch / "runs/0002/run.json", R"({"program": "sprung", "outcome": "done", "frames_written": 7, "files": []})");
  write_text(scratch / "runs/0003/run.json", R"({"program": "sprung", "outcome": "running", "frames_written": 7, "files": []})");
  for (const int run : {1, 2}) EXPECT_THAT(command_of(sweep, run, "sprung"), IsSupersetOf({"--resume"})) << run;
  EXPECT_THAT(command_of(sweep, 3, "sprung"), IsSupersetOf({"--overwrite"}));
}

TEST(Slurm, TasksShareTheRuns) {
  const ScratchFolder scratch;
  SweepSettings of_slurm = settings();
  of_slurm.engine = "slurm";
  of_slurm.array_size = 3;
  SweepFolder sweep(scratch.path(), of_slurm);
  EXPECT_THAT(runs_to_do(sweep, 0), ElementsAre(1, 4));
  EXPECT_THAT(runs_to_do(sweep, 2), ElementsAre(3));
  EXPECT_THAT(tasks_to_do(sweep), ElementsAre(0, 1, 2));
  sweep.note(2, done(0.1, ""));
  EXPECT_THAT(tasks_to_do(sweep), ElementsAre(0, 2));
  sweep.note(1, done(0.1, ""));
  EXPECT_THAT(tasks_to_do(sweep), ElementsAre(0, 2));
  sweep.note(4, done(0.1, ""));
  EXPECT_THAT(tasks_to_do(sweep), ElementsAre(2));
}

TEST(Slurm, ScriptPassesWhatSlurmAsksFor) {
  SweepSettings of_slurm = settings();
  of_slurm.engine = "slurm";
  of_slurm.array_size = 3;
  SweepFolder sweep("/it's here", of_slurm);
  sweep.progress().jobs = 2;
  const std::string script =
      slurm_script(sweep, {.account = "lab", .partition = "long", .time = "2:00:00"}, {0, 1, 2}, "/bin/sprung");
  EXPECT_THAT(script, AllOf(HasSubstr("#SBATCH --array=0-2\n"), HasSubstr("--cpus-per-task=2\n"), HasSubstr("--account=lab\n"),
                            HasSubstr("--partition=long\n"), HasSubstr("--time=2:00:00\n"), HasSubstr("--requeue\n")));
  EXPECT_THAT(script, HasSubstr("exec /bin/sprung sweep --task \"$SLURM_ARRAY_TASK_ID\" --out '/it'\\''s here'\n"));
  EXPECT_THAT(script, HasSubstr("#SBATCH --output=\"/it's here/slurm\"/task-%a.log\n"));
  EXPECT_THAT(slurm_script(sweep, {}, {0}, "sprung"), Not(HasSubstr("--account")));
  const SweepFolder odd(R"(/100%a "in\quotes")", of_slurm);
  EXPECT_THAT(slurm_script(odd, {}, {0}, "sprung"), HasSubstr(R"(--output="/100%%a \"in\\quotes\"/slurm"/task-%a.log)"));
}

TEST(Slurm, ArraysNameRangesOfTasks) {
  EXPECT_EQ(array_of({0}), "0");
  EXPECT_EQ(array_of({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
}

}  // namespace
}  // namespace sprung
