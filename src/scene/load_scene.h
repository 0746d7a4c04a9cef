// Loads a scene file and builds its simulator.
#pragma once

#include "scene/building/scene_builder.h"
#include "simulation/simulator.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// A scene file, with what the command line changes of it.
struct SceneSource {
  std::string file;
  std::vector<std::string> overrides{};   ///< `key.path=json`
  std::vector<std::string> mesh_paths{};  ///< folders
  std::optional<std::string> text{};      ///< JSON text to read instead of the file
};

/// The JSON text of a source. Throws FileError if the file cannot be read.
[[nodiscard]] std::string scene_text(const SceneSource& source);

struct LoadedScene {
  Scene scene;
  Simulator simulator;
  int frames = 1;
  double largest_stable_step = 0.0;  ///< [s]; infinity without a bound
  std::vector<NamedReport> meshes;
  std::filesystem::path initial_state;      ///< folder or file that the scene begins from; empty: none
  ObjSources sources;                       ///< the files of bodies
  std::vector<StepAdjustment> adjustments;  ///< of bodies that were adjusted for larger steps
  std::vector<std::string> warnings;        ///< without duplicates
};

/// A scene that was read and built, without a simulator.
struct PreparedScene {
  std::string file;
  Scene scene;
  BuiltScene built;
};

/// Throws FileError if the scene cannot be read, and InputError with every problem, each with its file. Several threads may load
/// scenes at the same time. Costly: imports meshes, builds bodies, estimates the stable step and checks the start.
[[nodiscard]] LoadedScene load_scene(const SceneSource& source);

// The same in two parts.

/// Throws FileError if the scene cannot be read, and InputError with every problem of its text, meshes and bodies.
[[nodiscard]] PreparedScene prepare_scene(const SceneSource& source);

/// Makes the simulator. Throws InputError if the start is refused.
[[nodiscard]] LoadedScene start_scene(PreparedScene prepared);

}  // namespace sprung
