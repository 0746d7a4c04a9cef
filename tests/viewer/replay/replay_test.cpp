// Replays and HTML files show what a run wrote.
#include "base/error.h"
#include "output/run_output.h"
#include "scene/load_scene.h"
#include "scene/scene_text.h"
#include "viewer/replay/html_export.h"
#include "viewer/test_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <fstream>
#include <set>

namespace sprung {
namespace {

using ::testing::HasSubstr;
using testing::Json;
using testing::Received;
using testing::ServingServer;
using testing::TestPage;

constexpr int kFrames = 5;

// Two triangles of three vertices each, welded along the edge that they share: six vertices, four particles, five springs.
TEST(Replay, SpringsAndPinsOfAWeldedMeshAreAtItsVertices) {
  const SceneFolder folder;
  folder.write("seam.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
  const std::string mesh = (folder.path() / "seam.obj").string();
  const std::string scene = R"({"version": 1, "duration": 0, "bodies": {
      "line": {"shape": {"type": "rope", "from": [5, 0, 0], "to": [6, 0, 0], "particles": 2}, "mass": 1,
               "springs": {"structural": {"stiffness": 10}}},
      "seam": {"shape": {"type": "mesh", "file": ")" +
                            mesh + R"(", "weld": 0}, "mass": 1, "pins": [{"indices": [1]}],
               "springs": {"structural": {"stiffness": 10}}}}})";
  LoadedScene loaded = load_scene({.file = folder.write("scene.json", scene).string()});
  RunOutput output(
      OutputFolder((folder.path() / "run").string(), false),
      {.scene = loaded.scene.resolved, .steps_per_frame = loaded.simulator.settings().steps_per_frame, .sources = loaded.sources},
      loaded.simulator);
  output.write_frame(loaded.simulator, FrameRunner(loaded.simulator).first_frame());
  output.flush();
  const Replay replay(folder.path() / "run");
  EXPECT_THAT(replay.scene_text(), HasSubstr("\"complete\":true"));
  const Topology topology = replay.topology();
  const FrameState state = replay.state(1);
  ASSERT_EQ(state.positions.cols(), 8);
  ASSERT_EQ(topology.springs.cols(), 1 + 5);
  for (Eigen::Index s = 0; s < topology.springs.cols(); ++s) {
    const auto ends = topology.springs.col(s);
    // Rest lengths are floats.
    EXPECT_FLOAT_EQ(static_cast<float>((state.positions.col(ends[0]) - state.positions.col(ends[1])).norm()),
                    topology.rest_lengths[static_cast<std::size_t>(s)]);
  }
  EXPECT_THAT(state.states, ::testing::ElementsAre(0, 0, 0, kPinned, 0, kPinned, 0, 0)) << "both vertices of the pinned particle";
}

// A cube of one cell carries a tetrahedron; a rope is pinned from frame 1 until frame 3 and from frame 4 on.
TEST(Replay, ShowsTheOtherBodiesOfALatticeAndPinsWhileTheyHold) {
  const SceneFolder folder;
  folder.write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string mesh = (folder.path() / "tetrahedron.obj").string();
  const std::string scene = R"({"version": 1, "duration": 1, "frame_rate": 10, "bodies": {
      "lattice": {"shape": {"type": "lattice", "file": ")" +
                            mesh + R"(", "cells": 1}, "material": "foam"},
      "line": {"shape": {"type": "rope", "from": [5, 0, 0], "to": [6, 0, 0], "particles": 2}, "mass": 1,
               "springs": {"structural": {"stiffness": 10}},
               "pins": [{"indices": [0], "until": 0.2}, {"indices": [0], "from": 0.3}]}}})";
  LoadedScene loaded = load_scene({.file = folder.write("scene.json", scene).string()});
  RunOutput output(OutputFolder((folder.path() / "run").string(), false),
                   {.scene = loaded.scene.resolved,
                    .frame_rate = 10.0,
                    .frames = kFrames,
                    .steps_per_frame = loaded.simulator.settings().steps_per_frame,
                    .sources = loaded.sources},
                   loaded.simulator);
  FrameRunner runner(loaded.simulator);
  for (int frame = 1; frame <= kFrames; ++frame) {
    output.write_frame(loaded.simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
  }
  output.finish("done");
  EXPECT_GT(loaded.simulator.network().bodies[0].contact_only, 0) << "of edges that are longer than the cell";
  const Replay replay(folder.path() / "run");
  EXPECT_THAT(replay.scene_text(), HasSubstr("\"complete\":true"));
  const Topology topology = replay.topology();
  EXPECT_EQ(topology.triangles.cols(), 4);
  EXPECT_EQ(topology.particles, 4 + 2);
  ASSERT_EQ(topology.springs.cols(), 1) << "of the rope; those of the cell have ends that frames do not hold";
  EXPECT_EQ(topology.springs.col(0), Eigen::Vector2i(4, 5));
  EXPECT_EQ(topology.rest_lengths, std::vector<float>{1.0F});
  std::vector<int> holds;
  for (int frame = 1; frame <= kFrames; ++frame) holds.push_back(replay.state(frame).states[4] == kPinned ? 1 : 0);
  EXPECT_THAT(holds, ::testing::ElementsAre(1, 1, 0, 1, 1));
}

// The cloth hangs by its first row and falls into it until structural springs break; the quad beside it does not.
TEST(Replay, TellsWhichTrianglesAreGoneFromAFrameOn) {
  const SceneFolder folder;
  folder.write("quad.obj", "v 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\nf 1 2 3 4\n");
  const std::string mesh = (folder.path() / "quad.obj").string();
  const std::string scene = R"({"version": 1, "duration": 1, "frame_rate": 25, "step": 0.001, "bodies": {
      "a_quad": {"shape": {"type": "mesh", "file": ")" +
                            mesh + R"("}, "mass": 1, "springs": {"structural": {"stiffness": 10}}},
      "cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [5, 5]}, "mass": 1, "place": {"rotation": [-90, 0, 0]},
                "springs": {"structural": {"stiffness": 200, "damping": 0.1, "break": 0.05}},
                "pins": [{"indices": [0, 1, 2, 3, 4]}]}}})";
  LoadedScene loaded = load_scene({.file = folder.write("scene.json", scene).string()});
  constexpr int kShown = 20;
  RunOutput output(OutputFolder((folder.path() / "run").string(), false),
                   {.scene = loaded.scene.resolved,
                    .frame_rate = 25.0,
                    .frames = kShown,
                    .steps_per_frame = loaded.simulator.settings().steps_per_frame},
                   loaded.simulator);
  FrameRunner runner(loaded.simulator);
  std::vector<Eigen::Index> left;  // triangles of the cloth
  for (int frame = 1; frame <= kShown; ++frame) {
    output.write_frame(loaded.simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
    left.push_back(loaded.simulator.network().bodies[1].surface.triangles.cols());
  }
  output.finish("done");
  ASSERT_LT(left.back(), left.front());
  const Replay replay(folder.path() / "run");
  const Json torn = Json::parse(replay.scene_text())["torn"];
  for (int frame = 1; frame <= kShown; ++frame) {
    std::set<int> gone;
    for (const Json& tear : torn) {
      if (tear["frame"] <= frame) gone.insert(tear["triangles"].begin(), tear["triangles"].end());
    }
    EXPECT_EQ(static_cast<Eigen::Index>(gone.size()), left.front() - left[static_cast<std::size_t>(frame - 1)]) << frame;
    EXPECT_TRUE(gone.empty() || (*gone.begin() >= 2 && *gone.rbegin() < replay.topology().triangles.cols())) << "not the quad's";
  }
}

/// A cloth that falls on a ball that moves, recorded.
class RecordedCloth : public ::testing::Test {
 protected:
  RecordedCloth() {
    const std::string scene = R"({"version": 1, "duration": 1, "frame_rate": 25,
      "bodies": {"cloth": {"shape": {"type": "cloth", "size": [1, 1], "resolution": [8, 8]}, "mass": 0.1, "thickness": 0.01,
                           "springs": {"structural": {"stiffness": 100}}, "place": {"rotation": [-90, 0, 0]},
                           "pins": [{"indices": [0]}]}},
      "obstacles": {"ball": {"shape": {"type": "sphere", "radius": 0.2}, "place": {"position": [0, -0.5, 0]},
                             "motion": {"keyframes": [{"time": 0}, {"time": 1, "position": [1, 0, 0]}]}},
                    "floor": {"shape": {"type": "half_space"}, "place": {"position": [0, -1, 0]}}}})";
    LoadedScene loaded = load_scene({.file = folder_.write("scene.json", scene).string()});
    RunOutput output(OutputFolder(run_folder().string(), false),
                     {.scene = loaded.scene.resolved,
                      .frame_rate = 25.0,
                      .frames = kFrames,
                      .steps_per_frame = loaded.simulator.settings().steps_per_frame},
                     loaded.simulator);
    FrameRunner runner(loaded.simulator);
    for (int frame = 1; frame <= kFrames; ++frame) {
      output.write_frame(loaded.simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
      positions_.push_back(loaded.simulator.positions());
    }
    output.finish("done");
  }
  [[nodiscard]] std::filesystem::path run_folder() const { return folder_.path() / "frames"; }

  SceneFolder folder_;
  std::vector<Points> positions_;
};

TEST_F(RecordedCloth, APageGetsThePositionsOfTheFiles) {
  ReplaySession session(run_folder());
  const ServingServer server(session);
  TestPage page(server.port());
  EXPECT_EQ(page.text("hello")["mode"], "replay");
  const Json scene = page.text("scene");
  EXPECT_TRUE(scene["complete"]);
  EXPECT_EQ(scene["frames"], kFrames);
  EXPECT_EQ(scene["diagnostics"]["rows"].size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(scene["obstacles"][0]["motion"], "rigid");
  for (const int frame : {3, 1, kFrames}) {
    page.send({{"do", "seek"}, {"frame", frame}});
    const Received shown =
        page.frame([&](const Received& message) { return message.frame() == static_cast<std::uint32_t>(frame); });
    EXPECT_DOUBLE_EQ(shown.time(), (frame - 1) / 25.0);
    for (Index i = 0; i < 64; ++i) {
      EXPECT_EQ(shown.position(static_cast<std::size_t>(i)),
                Vector3(positions_[static_cast<std::size_t>(frame - 1)].col(i).cast<float>().cast<double>()));
    }
  }
  page.send({{"do", "play"}});
  EXPECT_THAT(page.text("error")["text"].get<std::string>(), HasSubstr("play"));
}

TEST_F(RecordedCloth, ShowsSurfacesOfARunWithoutARecord) {
  std::filesystem::remove(run_folder() / "record.bin");
  const Replay replay(run_folder());
  const Json scene = Json::parse(replay.scene_text());
  EXPECT_FALSE(scene["complete"]);
  EXPECT_THAT(scene["warnings"].back().get<std::string>(), HasSubstr("record.bin"));
  EXPECT_EQ(replay.topology().springs.cols(), 0);
  EXPECT_EQ(replay.topology().triangles.cols(), 2 * 7 * 7);
  EXPECT_EQ(replay.state(2).positions, positions_[1]);
}

TEST_F(RecordedCloth, ShowsEverythingInAnotherPlaceWithoutItsScene) {
  const std::filesystem::path moved = folder_.path() / "moved";
  std::filesystem::rename(run_folder(), moved);
  std::filesystem::remove(folder_.path() / "scene.json");
  const Replay replay(moved);
  EXPECT_TRUE(Json::parse(replay.scene_text())["complete"]);
  EXPECT_EQ(replay.topology().springs.cols(), 2 * 7 * 8);
  EXPECT_EQ(replay.state(2).states[0], kPinned);
  EXPECT_GT(replay.state(2).speeds[1], 0.0);
}

TEST_F(RecordedCloth, APageOrFileTellsNoFolderOfTheMachine) {
  Json summary = Json::parse(std::ifstream(run_folder() / "run.json"));
  summary["warnings"] = {"\"/home/ada/my.obj\" has 2 pieces (0.5 m/s), see ../secret/notes.txt"};
  summary["scene"]["obstacles"]["ball"]["shape"]["file"] = "/home/ada/two words/ball.obj";
  folder_.write("frames/run.json", summary.dump());
  const std::string text = html_animation(Replay(run_folder()), testing::kPage).text;
  EXPECT_THAT(text, HasSubstr("\\\"my.obj\\\" has 2 pieces (0.5 m/s), see notes.txt"));
  EXPECT_THAT(text, HasSubstr("\"ball.obj\""));
  for (const std::string& secret : {std::string("ada"), std::string("secret"), folder_.path().string()}) {
    EXPECT_EQ(text.find(secret), std::string::npos) << secret;
  }
}

TEST_F(RecordedCloth, ABrokenFolderSaysWhatIsMissing) {
  const auto refusal = [&](const std::filesystem::path& folder) -> std::string {
    try {
      const Replay replay(folder);
      (void)replay.state(kFrames);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("run.json"));
  EXPECT_THAT(refusal(folder_.path() / "nowhere"), HasSubstr("nowhere"));
  EXPECT_EQ(refusal(run_folder()), "");
  folder_.write("frames/record.bin", "damaged");
  EXPECT_THAT(refusal(run_folder()), HasSubstr("record.bin"));
  std::filesystem::remove(run_folder() / "record.bin");
  EXPECT_EQ(refusal(run_folder()), "");
  std::filesystem::remove(run_folder() / "cloth" / "cloth.0005.obj");
  EXPECT_THAT(refusal(run_folder()), HasSubstr("cloth.0005.obj"));
  folder_.write("frames/cloth/cloth.0005.obj", "v 0 0 0\n");
  EXPECT_THAT(refusal(run_folder()), HasSubstr("1 vertices"));
  Json summary = Json::parse(std::ifstream(run_folder() / "run.json"));
  summary["frames_written"] = 2000000000;
  folder_.write("frames/run.json", summary.dump());
  EXPECT_THROW((void)Replay(run_folder()).state(20000), FileError) << "more digits than the names of the files have";
  folder_.write("frames/run.json", R"({"scene": )" + std::string(100000, '[') + std::string(100000, ']') + "}");
  EXPECT_THAT(refusal(run_folder()), HasSubstr("nested too deeply"));
  folder_.write("frames/run.json", "{}");
  EXPECT_THAT(refusal(run_folder()), HasSubstr("run.json"));
}

TEST_F(RecordedCloth, AFrameOrASummaryThatNoRunWritesIsRefused) {
  std::filesystem::remove(run_folder() / "record.bin");
  const Json summary = Json::parse(std::ifstream(run_folder() / "run.json"));
  const auto refusal = [&](const char* key, const Json& value) -> std::string {
    Json changed = summary;
    changed[key] = value;
    folder_.write("frames/run.json", changed.dump());
    try {
      (void)Replay(run_folder()).state(2);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  for (const Json& count : std::vector<Json>{1.5, -1, 3e9, 1e300}) {
    EXPECT_THAT(refusal("frames_written", count), HasSubstr("whole number")) << count;
  }
  EXPECT_THAT(refusal("files", {"cloth.obj"}), HasSubstr("name no file of each frame: cloth.obj"));
  const std::filesystem::path frame = run_folder() / "cloth" / "cloth.0002.obj";
  std::string vertices = "v nan 0 0\n";
  for (int k = 1; k < 64; ++k) vertices += "v 0 0 0\n";
  folder_.write("frames/cloth/cloth.0002.obj", vertices);
  EXPECT_THAT(refusal("version", "0"), HasSubstr("not finite"));
  std::filesystem::remove(frame);
  ASSERT_EQ(::mkfifo(frame.c_str(), 0600), 0);
  EXPECT_THAT(refusal("version", "0"), HasSubstr("not a regular file"));
}

std::vector<std::uint8_t> bytes_of_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = (bits << 6U) | static_cast<std::uint32_t>(digits.find(letter));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<std::uint8_t>((bits >> static_cast<unsigned>(count -= 8)) & 255U));
  }
  return bytes;
}

TEST_F(RecordedCloth, AnHtmlFileHasThePositionsWithinTheErrorThatItTells) {
  const HtmlAnimation animation = html_animation(Replay(run_folder()), testing::kPage);
  const std::string begin = "id=\"sprung-run\">";
  const std::size_t from = animation.text.find(begin) + begin.size();
  const Json data = Json::parse(animation.text.substr(from, animation.text.find("</script>", from) - from));
  EXPECT_EQ(data["error"], animation.error);
  // Half a level of the largest side, which the cloth, the floor and the ball keep below 10 m.
  EXPECT_LE(animation.error, 0.5 * 10.0 / 65535.0 * (1.0 + 1e-9));
  ASSERT_EQ(data["times"].size(), static_cast<std::size_t>(kFrames));
  const std::vector<std::uint8_t> packed = bytes_of_base64(data["data"]);
  const auto topology_bytes = data["topology_bytes"].get<std::size_t>();
  const auto level_bytes = data["level_bytes"].get<std::size_t>();
  const Replay replay(run_folder());
  const std::size_t values = 3 * 64;
  ASSERT_EQ(level_bytes, 2 * values * kFrames);
  std::vector<std::uint8_t> bytes(topology_bytes + level_bytes + std::size_t{64} * kFrames);
  uLongf size = bytes.size();
  ASSERT_EQ(uncompress(bytes.data(), &size, packed.data(), packed.size()), Z_OK);
  ASSERT_EQ(size, bytes.size());
  const Bytes topology = topology_message({.run = 0, .generation = 1}, replay.topology());
  EXPECT_TRUE(
      std::equal(topology.begin(), topology.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(topology_bytes)));
  std::vector<std::uint16_t> levels(values);
  std::vector<std::uint8_t> states(64);
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    const std::uint8_t* low = bytes.data() + topology_bytes + 2 * values * frame;
    const FrameState shown = replay.state(static_cast<int>(frame) + 1);
    for (std::size_t k = 0; k < values; ++k) {
      levels[k] = static_cast<std::uint16_t>(levels[k] + low[k] + 256U * low[values + k]);
      const double value =
          data["bounds"]["min"][k % 3].get<double>() + data["bounds"]["size"][k % 3].get<double>() * levels[k] / 65535.0;
      EXPECT_LE(std::abs(value - positions_[frame].data()[k]), animation.error * (1.0 + 1e-12));
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i] = static_cast<std::uint8_t>(states[i] + bytes[topology_bytes + level_bytes + states.size() * frame + i]);
    }
    EXPECT_EQ(states, shown.states);
    const Vector3 ball = shown.poses.at(0).translation();
    EXPECT_EQ(data["poses"][frame][0][9], ball.x());
    EXPECT_NEAR(ball.x(), static_cast<double>(frame) / 25.0, 1e-12) << "a metre a second";
  }
}

}  // namespace
}  // namespace sprung
