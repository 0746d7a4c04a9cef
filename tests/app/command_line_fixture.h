// Scenes to run the program on, and what tests of it share.
#pragma once

#include "app/program.h"
#include "base/scratch_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace sprung::testing {

using nlohmann::json;

inline constexpr auto kPatience = std::chrono::minutes(5);  // only ends what hangs

/// A rope of 5 particles that swings for 0.2 s: 7 frames.
inline json rope_scene() {
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
inline json cloth_scene() {
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
    "obstacles": { "ball": { "shape": { "type": "sphere", "radius": 0.3 }, "friction": 0.3 } }
  })");
}

/// Two masses on a spring that is far too stiff for the step.
inline json diverging_scene() {
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
  [[nodiscard]] json summary() const { return json::parse(read_text(scratch_ / "out/run.json")); }
  [[nodiscard]] bool wrote_something() const { return std::filesystem::exists(out()); }

  static Ending run(const std::vector<std::string>& arguments) { return Program(arguments).wait(); }

  template <class Condition>
  static bool wait_until(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  static bool wait_for(const std::filesystem::path& file) {
    return wait_until([&] { return std::filesystem::exists(file); });
  }

  static bool is_without_viewer(const Ending& ending) { return ending.err.find("built without the viewer") != std::string::npos; }

  ScratchFolder scratch_;
};

}  // namespace sprung::testing
