// A run that is stopped in any way and resumed is the run that was never stopped.
#include "app/command_line_fixture.h"
#include "base/test_seed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

namespace sprung::testing {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// A cloth with self-contact on a ball in gusts, a strip that tears, a rope that lets a jelly fall as their link breaks, a pin that
/// moves and one that ends, and a rope that sleeps.
json scene_of_all() {
  return json::parse(R"({
    "duration": 1.2,
    "frame_rate": 25,
    "step": 0.0005,
    "air": { "gusts": { "speed": 2.0, "length": 0.5 } },
    "output": { "forces": true },
    "bodies": {
      "cloth": {
        "shape": { "type": "cloth", "size": [0.5, 0.5], "resolution": [6, 6] }, "material": "cotton", "self_contact": true,
        "place": { "position": [0.02, 0.5, 0.01], "rotation": [-90, 10, 0] }
      },
      "strip": {
        "shape": { "type": "cloth", "size": [0.2, 0.4], "resolution": [3, 5] }, "material": "cotton",
        "springs": { "structural": { "break": 0.04 } }, "place": { "position": [1, 1, 0] },
        "pins": [
          { "box": [[0.8, 1.19, -0.1], [1.2, 1.21, 0.1]] },
          { "box": [[0.8, 0.79, -0.1], [1.2, 0.81, 0.1]],
            "motion": { "keyframes": [ { "time": 0 }, { "time": 1, "position": [0, -0.3, 0] } ] } }
        ]
      },
      "rope": {
        "shape": { "type": "rope", "from": [-0.8, 1.2, 0], "to": [-0.4, 1.2, 0], "particles": 5 }, "material": "hemp",
        "pins": [ { "indices": [0], "until": 0.9 } ]
      },
      "jelly": {
        "shape": { "type": "lattice", "file": ")" SPRUNG_SOURCE_DIR R"(/meshes/ball.obj", "cells": 1 }, "material": "soft_jelly",
        "place": { "position": [-0.4, 1.0, 0] }
      },
      "sleeper": { "shape": { "type": "rope", "from": [-1.4, 0.01, 0], "to": [-1.2, 0.01, 0], "particles": 3 }, "material": "hemp" }
    },
    "attachments": [ { "first": { "body": "rope", "indices": [4] }, "second": { "body": "jelly" }, "break_force": 12 } ],
    "obstacles": {
      "floor": { "shape": { "type": "half_space" }, "friction": 0.4 },
      "ball": { "shape": { "type": "sphere", "radius": 0.2 }, "place": { "position": [0, 0.25, 0] }, "friction": 0.4 }
    }
  })");
}

/// A rope that swings for so long that no machine ends the run before it is interrupted.
json long_rope_scene() {
  json scene = rope_scene();
  scene["duration"] = 10.0;
  return scene;
}

/// A text without the column of wall times.
std::string without_times(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::size_t column = 0;
  std::string result;
  for (bool is_head = true; std::getline(lines, line); is_head = false) {
    std::istringstream fields(line);
    std::string field;
    for (std::size_t k = 0; std::getline(fields, field, ','); ++k) {
      if (is_head && field == "frame_ms") column = k;
      if (k != column || column == 0) result += field + ",";
    }
    result += "\n";
  }
  return result;
}

/// The files of a run, without wall times, threads and checkpoints.
std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const std::string& name : listing(folder)) {
    if (name.ends_with('/') || name == "checkpoint.bin") continue;
    std::string text = read_text(folder / name);
    if (name == "diagnostics.csv") text = without_times(text);
    if (name == "run.json") {
      json summary = json::parse(text);
      summary.erase("wall_seconds");
      summary.erase("threads");
      text = summary.dump(1);
    }
    files[name] = std::move(text);
  }
  return files;
}

void expect_same(const std::filesystem::path& run, const std::filesystem::path& undisturbed) {
  const auto files = files_of(run);
  const auto wanted = files_of(undisturbed);
  for (const auto& [name, text] : wanted) {
    const auto found = files.find(name);
    EXPECT_NE(found, files.end()) << name << " is missing";
    EXPECT_TRUE(found == files.end() || found->second == text) << name << " differs";
  }
  for (const auto& [name, text] : files) EXPECT_TRUE(wanted.contains(name)) << name << " is left over";
}

class Resume : public CommandLine {
 protected:
  [[nodiscard]] std::filesystem::path folder(const std::string& name = "out") const { return scratch_ / name; }
  [[nodiscard]] std::string checkpoint() const { return (folder() / "checkpoint.bin").string(); }

  /// Runs the scene without a break, into another folder.
  std::filesystem::path undisturbed(const std::string& scene, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", scene, "--out", out("whole"), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).code, 0);
    return folder("whole");
  }

  [[nodiscard]] Ending resume(const std::string& scene, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", scene, "--out", out(), "--resume"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  /// Resumes and interrupts a run when `frames` are written.
  void run_until(int frames, const std::string& scene, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", scene, "--out", out(), "--resume", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Program program(arguments);
    const auto is_written = [&] { return std::filesystem::exists(folder() / "run.json") && summary()["frames_written"] >= frames; };
    ASSERT_TRUE(wait_until(is_written));
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
  }

  /// Expects that the run is refused in one line, with nothing changed.
  void expect_refusal(const Ending& ending, const std::string& reason) const {
    EXPECT_EQ(ending.code, 5) << ending.err;
    EXPECT_THAT(ending.err, ContainsRegex(reason));
    EXPECT_EQ(std::ranges::count(ending.err, '\n'), 1) << ending.err;
  }
};

TEST_F(Resume, TwentyKillsChangeNoBit) {
  const std::string scene = save(scene_of_all());
  std::mt19937_64 random(test::seeded(47));
  const std::filesystem::path wanted = undisturbed(scene, {"--checkpoint", "0", "--threads", "1"});
  for (int kills = 0; kills < 20;) {
    Program program(
        {"run", scene, "--out", out(), "--resume", "--quiet", "--checkpoint", "0.02", "--threads", std::to_string(1 + kills % 2)});
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 400'000));
    program.send(SIGKILL);
    if (program.wait().signal == SIGKILL) {
      ++kills;
      continue;
    }
    expect_same(folder(), wanted);  // it was faster
    std::filesystem::remove_all(folder());
  }
  EXPECT_EQ(resume(scene).code, 0);
  expect_same(folder(), wanted);
  const json whole = json::parse(read_text(folder("whole") / "run.json"));
  EXPECT_FALSE(whole["torn_faces"].empty());
  EXPECT_FALSE(whole["broken_attachments"].empty());
}

TEST_F(Resume, AnInterruptChangesNoBit) {
  const std::string scene = save(scene_of_all());
  run_until(16, scene, {"--checkpoint", "1000"});
  ASSERT_TRUE(std::filesystem::exists(checkpoint()));
  EXPECT_EQ(summary()["outcome"], "interrupted");
  const Ending resumed = resume(scene);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, ContainsRegex("goes on after frame [0-9]+ of 31"));
  expect_same(folder(), undisturbed(scene));
}

// Two pins pull a rope beyond its limit in the first frames. The warning at the end counts these, and the one about their vertices
// comes once.
TEST_F(Resume, WarningsAreThoseOfAllFrames) {
  json scene = rope_scene();
  scene["frame_rate"] = 25;
  scene["step"] = 0.0001;  // no machine ends the run before it is interrupted
  scene["duration"] = 4.0;
  scene["stretch_limit"] = {{"max_stretch", 0.02}};
  scene["bodies"]["rope"]["pins"] = json::parse(R"([
    { "indices": [0] },
    { "indices": [4],
      "motion": { "keyframes": [ { "time": 0 }, { "time": 0.1, "position": [0.2, 0, 0] }, { "time": 0.2, "position": [0, 0, 0] } ] } }
  ])");
  const std::string file = save(scene);
  run_until(20, file);
  EXPECT_EQ(resume(file).code, 0);
  expect_same(folder(), undisturbed(file));
  const json warnings = json::parse(read_text(folder("whole") / "run.json"))["warnings"];
  EXPECT_THAT(warnings.dump(), HasSubstr("the stretch limit was missed"));
}

// As a kill leaves them while the program appends.
TEST_F(Resume, HalfLinesAndFilesOfLaterFramesAreCut) {
  json scene = long_rope_scene();
  scene["output"] = {{"forces", true}};
  const std::string file = save(scene);
  run_until(3, file);
  for (const char* name : {"diagnostics.csv", "forces.csv", "record.bin"}) {
    std::ofstream(folder() / name, std::ios::app | std::ios::binary) << "6,0.16";
  }
  write_text(folder() / "rope/rope.0302.obj", "v 0 0 0\n");
  write_text(folder() / "rope/.rope.0006.obj.tmp", "v 0");
  EXPECT_EQ(resume(file).code, 0);
  expect_same(folder(), undisturbed(file));
}

TEST_F(Resume, BeginsARunWithoutACheckpoint) {
  const std::string scene = save(rope_scene());
  const Ending first = resume(scene, {"--checkpoint", "0"});
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("there is no checkpoint"));
  EXPECT_FALSE(std::filesystem::exists(checkpoint()));
}

TEST_F(Resume, BeginsAKilledRunWithoutACheckpointAgain) {
  const std::string scene = save(rope_scene());
  {
    Program program({"run", scene, "--out", out(), "--checkpoint", "0", "--frames", "100000", "--quiet"});
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(folder() / "run.json") && summary()["frames_written"] > 9; }));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().signal, SIGKILL);
  }
  EXPECT_EQ(resume(scene, {"--frames", "12"}).code, 0);
}

// Its frames would be removed before they come again.
TEST_F(Resume, ARunThatEndedWithoutACheckpointIsKept) {
  const std::string scene = save(rope_scene());
  ASSERT_EQ(resume(scene, {"--checkpoint", "0"}).code, 0);
  const auto before = files_of(folder());
  expect_refusal(resume(scene, {"--frames", "12"}), "its 7 frames have no checkpoint\\.bin to go on from.*--overwrite");
  EXPECT_EQ(files_of(folder()), before);
}

TEST_F(Resume, NeedsNoRunSummary) {
  const std::string scene = save(long_rope_scene());
  run_until(3, scene);
  write_text(folder() / "run.json", "");
  EXPECT_EQ(resume(scene).code, 0);
  expect_same(folder(), undisturbed(scene));
}

TEST_F(Resume, AFolderThatLostItsFilesIsNotComplete) {
  const std::string scene = save(rope_scene());
  ASSERT_EQ(resume(scene).code, 0);
  std::filesystem::remove(folder() / "diagnostics.csv");
  expect_refusal(resume(scene), "diagnostics\\.csv is shorter");
}

TEST_F(Resume, ASceneDoesNotBeginFromTheFolderThatItReplaces) {
  json scene = rope_scene();
  ASSERT_EQ(resume(save(scene)).code, 0);
  scene["initial_state"] = out();
  const auto before = files_of(folder());
  expect_refusal(run({"run", save(scene), "--out", out(), "--overwrite"}), "the scene begins from the run in it");
  EXPECT_EQ(files_of(folder()), before);
}

TEST_F(Resume, AFinishedRunGoesOnToALongerDuration) {
  json scene = scene_of_all();
  scene["duration"] = 0.5;
  const std::string file = save(scene);
  EXPECT_EQ(resume(file, {"--quiet"}).code, 0);
  const auto before = files_of(folder());
  const Ending same = resume(file);
  EXPECT_EQ(same.code, 0);
  EXPECT_THAT(same.err, HasSubstr("nothing is left to do"));
  EXPECT_EQ(files_of(folder()), before);
  scene["duration"] = 0.7;
  save(scene);
  EXPECT_EQ(resume(file).code, 0);
  expect_same(folder(), undisturbed(file));
}

TEST_F(Resume, ARunOfAnotherSceneIsRefusedWithTheDifferences) {
  json scene = long_rope_scene();
  const std::string file = save(scene);
  run_until(2, file);
  const auto before = files_of(folder());
  scene["bodies"]["rope"]["mass"] = 0.2;
  scene["bodies"]["rope"]["friction"] = 0.1;
  save(scene);
  expect_refusal(resume(file), "bodies\\.rope\\.friction is 0\\.1, was .*bodies\\.rope\\.mass is 0\\.2, was 0\\.1.*--overwrite");
  EXPECT_EQ(files_of(folder()), before);
  std::filesystem::remove(checkpoint());
  expect_refusal(resume(file), "bodies\\.rope\\.mass is 0\\.2, was 0\\.1");
  EXPECT_EQ(files_of(folder()), before);
}

TEST_F(Resume, AnotherMeshOfTheSameNameIsNoticedAndAnotherPlaceIsNot) {
  json scene = long_rope_scene();
  scene["obstacles"]["floor"] = {{"shape", {{"type", "mesh"}, {"file", "floor.obj"}}}};
  const std::string file = save(scene);
  const std::string floor = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 3 2\nf 1 4 3\n";
  write_text(scratch_ / "floor.obj", floor);
  run_until(2, file);
  write_text(scratch_ / "floor.obj", "v -2 0 -1\n" + floor.substr(floor.find('\n') + 1));
  expect_refusal(resume(file), "the mesh, or the state in \"initial_state\", of obstacle \"floor\" is another one");
  std::filesystem::remove(scratch_ / "floor.obj");
  write_text(scratch_ / "meshes/plane.obj", floor);
  scene["obstacles"]["floor"]["shape"]["file"] = "meshes/plane.obj";
  save(scene);
  const Ending moved = resume(file);
  EXPECT_EQ(moved.code, 0) << moved.err;
}

// Frames would show one mesh before the checkpoint and the other one after it.
TEST_F(Resume, OtherFacesOfABodyAreNoticed) {
  json scene = long_rope_scene();
  scene["bodies"]["rope"]["shape"] = {{"type", "mesh"}, {"file", "sail.obj"}};
  const std::string file = save(scene);
  const std::string corners = "v 0 2 0\nv 1 2 0\nv 1 2 1\nv 0 2 1\n";
  write_text(scratch_ / "sail.obj", corners + "f 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(resume(file, {"--frames", "3"}).code, 0);
  write_text(scratch_ / "sail.obj", corners + "f 1 3 4\nf 1 2 3\n");
  expect_refusal(resume(file), "the mesh, or the state in \"initial_state\", of body \"rope\" is another one");
}

TEST_F(Resume, TheOrderOfObstaclesIsPartOfAScene) {
  json scene = long_rope_scene();
  scene["obstacles"] = {{"left", {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}}},
                        {"right", {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"place", {{"position", {1, 0, 0}}}}}}};
  const std::string file = save(scene);
  ASSERT_EQ(resume(file, {"--frames", "3", "--format", "none"}).code, 0);
  const json left = scene["obstacles"]["left"];
  const json right = scene["obstacles"]["right"];
  scene.erase("obstacles");
  std::string text = scene.dump();
  text.insert(1, R"("obstacles": {"right": )" + right.dump() + R"(, "left": )" + left.dump() + "},");
  write_text(file, text);
  expect_refusal(resume(file, {"--format", "none"}), "the order of obstacles is \"right\", \"left\", was \"left\", \"right\"");
}

TEST_F(Resume, NumbersThatAreWrittenOtherwiseAreTheSame) {
  json scene = rope_scene();
  scene["frame_rate"] = 30;
  const std::string file = save(scene);
  ASSERT_EQ(resume(file, {"--frames", "3"}).code, 0);
  scene["frame_rate"] = 30.0;
  scene["$schema"] = "scene.schema.json";
  save(scene);
  EXPECT_EQ(resume(file).code, 0);
}

// The links that act decide the pattern of implicit Euler's matrix.
TEST_F(Resume, AnAttachmentThatEngagedGoesOnUnderImplicitEuler) {
  const std::string file = save(json::parse(R"({
    "duration": 0.5,
    "integrator": { "type": "implicit_euler" },
    "bodies": {
      "rope": {
        "shape": { "type": "rope", "from": [0, 1, 0], "to": [0.5, 1, 0], "particles": 6 }, "density": 0.1,
        "springs": { "structural": { "stiffness": 200 } }, "pins": [ { "indices": [0] } ]
      },
      "tail": {
        "shape": { "type": "rope", "from": [0.5, 0.9, 0], "to": [0.5, 0.6, 0], "particles": 4 }, "density": 0.1,
        "springs": { "structural": { "stiffness": 200 } }
      }
    },
    "attachments": [ { "first": { "body": "tail", "indices": [0] }, "second": { "body": "rope", "indices": [5] }, "from": 0.14 } ]
  })"));
  ASSERT_EQ(resume(file, {"--frames", "6"}).code, 0);
  EXPECT_EQ(resume(file).code, 0);
  expect_same(folder(), undisturbed(file));
}

TEST_F(Resume, DamagedCheckpointsAreRefusedAndNothingIsLost) {
  const std::string scene = save(long_rope_scene());
  run_until(3, scene);
  const std::string good = read_text(checkpoint());
  const auto before = files_of(folder());
  const auto expect_refused = [&](const std::string& bytes, const std::string& reason) {
    write_text(checkpoint(), bytes);
    expect_refusal(resume(scene), "checkpoint\\.bin: cannot read: " + reason);
    EXPECT_EQ(files_of(folder()), before);
    EXPECT_EQ(read_text(checkpoint()), bytes);
  };
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 4);
  expect_refused(flipped, "it is damaged");
  expect_refused(good.substr(0, good.size() - 9), "it is truncated");
  expect_refused("not a checkpoint", "it is not a checkpoint of sprung");
  write_text(checkpoint(), good);
  std::filesystem::resize_file(folder() / "diagnostics.csv", 20);
  expect_refusal(resume(scene), "diagnostics\\.csv is shorter");
}

TEST_F(Resume, OtherFormatsAreRefused) {
  const std::string scene = save(long_rope_scene());
  run_until(3, scene);
  expect_refusal(resume(scene, {"--format", "none"}), "other names.*--format");
}

TEST_F(Resume, WritesTheFormatsOfTheRun) {
  const std::string scene = save(long_rope_scene());
  for (const char* format : {"none", "ply,npz,html"}) {
    std::filesystem::remove_all(folder());
    std::filesystem::remove_all(folder("whole"));
    run_until(3, scene, {"--format", format});
    EXPECT_EQ(resume(scene).code, 0);
    undisturbed(scene, {"--format", format});
    // An animation shows wall times, so that its bytes differ.
    EXPECT_EQ(std::filesystem::remove(folder() / "animation.html"), std::filesystem::remove(folder("whole") / "animation.html"));
    expect_same(folder(), folder("whole"));
  }
}

TEST_F(Resume, ASecondRunOfTheFolderNamesTheFirst) {
  json scene = rope_scene();
  scene["duration"] = 100.0;
  const std::string file = save(scene);
  Program first({"run", file, "--out", out(), "--quiet"});
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(folder() / "run.json"); }));
  for (const char* option : {"--resume", "--overwrite", "--quiet"}) {
    expect_refusal(run({"run", file, "--out", out(), option}), "process [0-9]+ writes a run into it");
  }
  first.send(SIGINT);
  EXPECT_EQ(first.wait().code, 130);
}

}  // namespace
}  // namespace sprung::testing
