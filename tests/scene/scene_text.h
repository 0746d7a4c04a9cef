// Scenes for tests, written to a temporary folder and read with overrides.
#pragma once

#include "base/error.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace sprung {

/// Makes failing tests print the line of the problem.
inline void PrintTo(const Problem& problem, std::ostream* stream) { *stream << to_string(problem); }

/// A folder for one test.
class SceneFolder {
 public:
  SceneFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    for (char& letter : name) {
      if (letter == '/') letter = '.';
    }
    folder_ = std::filesystem::path(testing::TempDir()) / ("sprung_scene_" + name);
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~SceneFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  [[nodiscard]] Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return read_scene(write("scene.json", text), overrides);
  }

 private:
  std::filesystem::path folder_;
};

/// The problems that `call` throws; empty if it throws none.
template <class Call>
[[nodiscard]] std::vector<Problem> problems_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// A cloth and a ball over the floor: the smallest scene with every kind of object.
inline constexpr const char* kPlainScene = R"({
  "version": 1,
  "duration": 1.0,
  "frame_rate": 30,
  "step": "auto",
  "bodies": {
    "banner": {
      "shape": { "type": "cloth", "size": [1, 1], "resolution": [3, 3] },
      "mass": 0.2,
      "springs": { "structural": { "stiffness": 400, "damping": 0.01 } },
      "pins": [ { "at": "corner", "which": ["min_min"] } ]
    }
  },
  "obstacles": { "floor": { "shape": { "type": "half_space", "normal": [0, 1, 0], "offset": -5 } } }
})";

/// A scene with every key of the format.
inline constexpr const char* kFullScene = R"({
  "version": 1,
  "duration": 4.0,
  "frame_rate": 30,
  "step": 0.0003333333333333333,
  "mass_scaling": 0.125,
  "gravity": [0, -9.81, 0.5],
  "air": { "drag": 0.25, "surface": { "normal": 1.25, "tangential": 0.02, "quadratic": true },
           "wind": { "keyframes": [ { "time": 0, "velocity": [1, 0, -2] }, { "time": 2, "velocity": [5, 0, 0] } ] },
           "gusts": { "speed": 3, "length": 2.5, "seed": 11 } },
  "integrator": { "type": "verlet", "damping": 0.001, "start_at_rest": true },
  "stretch_limit": { "max_stretch": 0.03, "max_compression": 0.9, "kinds": ["structural", "bend"], "iterations": 16,
                     "tolerance": 0.002, "tethers": true, "solver": "newton", "bodies": ["zebra", "rope"] },
  "contact": { "response": "penalty", "stiffness": 1000, "damping": 0.5, "start": "push_out" },
  "stability": "warn",
  "sleep": false,
  "perturb": false,
  "seed": 7,
  "strength_scatter": 0.25,
  "output": { "forces": true },
  "bodies": {
    "zebra": {
      "shape": { "type": "cloth", "size": [1.0, 2.0], "resolution": [64, 32] },
      "mass": 0.2,
      "springs": {
        "structural": { "stiffness": 400, "damping": 0.01 },
        "shear": { "modulus": 200, "damping": 0.005 },
        "bend": { "stiffness": 5 }
      },
      "place": { "position": [0, 2, 0], "rotation": [90, 0, 0], "scale": 1.5 },
      "pins": [ { "at": "corner", "which": ["min_min", "max_min"] }, { "nearest": [0, 2, 0] },
                { "box": [[-1, 1, -1], [1, 3, 1]], "motion": { "spin": [0, 90, 0] } },
                { "indices": [3, 5], "motion": { "keyframes": [ { "time": 0 }, { "time": 1, "position": [0, 1, 0] } ],
                                                 "interpolation": "smooth" } },
                { "sphere": [[0, 1, 0], 0.25], "name": "hand", "follow": "ball", "from": 0.5, "until": 2 } ],
      "point_masses": [ { "at": "corner", "which": ["max_max"], "mass": 0.75 }, { "indices": [1], "mass": 0.1 },
                        { "nearest": [0, 2, 0], "mass": 0.2 }, { "box": [[-1, 1, -1], [1, 3, 1]], "mass": 0.3 },
                        { "sphere": [[1, 2, 3], 4], "mass": 0.4 } ],
      "velocity": [1, 2, 3],
      "thickness": 0.005, "friction": 0.3, "static_friction": 0.4, "restitution": 0.1,
      "self_contact": false, "body_contact": false
    },
    "rope": { "shape": { "type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 5, "length": 1.25 }, "particle_mass": 0.5,
              "springs": { "structural": { "modulus": 30, "damping_ratio": 0.1 }, "bend": { "model": "angle", "modulus": 0.02 } },
              "pins": [ { "at": "corner", "which": ["from", "to"] } ] },
    "line": { "shape": { "type": "rope", "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]] }, "density": 0.1 },
    "jelly": { "shape": { "type": "solid", "size": [1, 2, 3], "resolution": [4, 5, 6] }, "density": 1000,
               "pins": [ { "at": "corner", "which": ["max_min_max"] } ] },
    "shirt": { "shape": { "type": "mesh", "file": "shirt.obj", "weld": 1e-6 }, "mass": 0.3, "normals": true,
               "springs": { "structural": { "stiffness": 100, "yield": 0.1, "groups": {
                 "sleeve": { "modulus": 300, "damping": 0.1, "tension_only": true }, "hem": { "stiffness": 10, "damping_time": 0.01, "yield": 0.2, "break": 0.5 } } },
                 "bend": { "stiffness": 1, "tension_only": true, "break": 0.5, "groups": { "collar": { "stiffness": 2 } } } },
               "pins": [ { "group": "collar", "from": 1 } ], "point_masses": [ { "group": "hem", "mass": 0.01 } ] },
    "scarf": { "shape": { "type": "cloth", "size": [1, 2], "resolution": [3, 5] }, "material": "wool", "mass": 0.3,
               "springs": { "structural": { "stiffness": 400 }, "bend": { "damping_time": 0.002 } } },
    "cable": { "shape": { "type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 5 }, "material": "steel_cable",
               "diameter": 0.008, "friction": 0.1 },
    "sponge": { "shape": { "type": "solid", "size": [1, 2, 3], "resolution": [4, 5, 6] }, "material": "foam" },
    "ham": { "shape": { "type": "tetrahedra", "file": "ham.msh" }, "material": "firm_jelly", "friction": 0.3,
             "volume": { "preserve": true } },
    "horse": { "shape": { "type": "lattice", "file": "horse.obj", "cells": 24 }, "material": "foam", "normals": true },
    "cow": { "shape": { "type": "lattice", "file": "cow.stl", "cell_size": 0.1 }, "material": "foam" },
    "balloon": { "shape": { "type": "mesh", "file": "ball.obj" }, "mass": 0.1, "pressure": 250, "volume": { "factor": 1.5 } }
  },
  "obstacles": {
    "bunny": { "shape": { "type": "mesh", "file": "bunny.obj" }, "place": { "position": [0, 0, 1], "scale": 0.6 },
               "friction": 0.4, "restitution": 0.2,
               "motion": { "keyframes": [ { "time": 0, "position": [0, 0, 0] },
                                          { "time": 1, "position": [0, 0.2, 0], "rotation": [0, 90, 0] } ] } },
    "floor": { "shape": { "type": "half_space", "normal": [0, 2, 0], "offset": 0.25 } },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 } },
    "crate": { "shape": { "type": "box", "size": [1, 2, 3] } },
    "pill": { "shape": { "type": "capsule", "radius": 0.1, "length": 2 } },
    "can": { "shape": { "type": "cylinder", "radius": 0.2, "height": 3 } },
    "hat": { "shape": { "type": "cone", "radius": 0.3, "height": 4 } },
    "egg": { "shape": { "type": "ellipsoid", "radii": [1, 2, 3] } },
    "heart": { "shape": { "type": "sequence", "files": ["b.obj", "a.obj"], "frame_rate": 24, "start": -0.5, "loop": true } },
    "lung": { "shape": { "type": "sequence", "files": "breath/lung.*.obj" } }
  },
  "attachments": [
    { "first": { "body": "zebra", "at": "corner", "which": ["min_max"] }, "second": { "body": "rope", "nearest": [0, 2, 0] },
      "stiffness": 500, "damping": 0.5, "rest_length": 0, "break_force": 40, "from": 0.5, "until": 3 },
    { "first": { "body": "rope", "indices": [2, 3] }, "second": { "body": "jelly" } },
    { "first": { "body": "shirt", "group": "cuff" }, "second": { "obstacle": "heart" }, "rest_length": 0.1 },
    { "first": { "body": "jelly", "box": [[0, 0, 0], [1, 1, 1]] }, "second": { "body": "shirt", "group": "hem" } },
    { "first": { "body": "rope", "nearest": [0, 0, 0] }, "second": { "body": "rope", "sphere": [[1, 0, 0], 0.1] } },
    { "first": { "body": "cow", "sphere": [[1, 0, 0], 0.1] }, "second": { "body": "rope", "at": "corner", "which": ["to"] } },
    { "first": { "body": "rope", "indices": [0] }, "second": { "body": "zebra", "indices": [3] } },
    { "first": { "body": "rope", "indices": [0] }, "second": { "body": "zebra", "box": [[0, 0, 0], [1, 1, 1]] } }
  ]
})";

}  // namespace sprung
