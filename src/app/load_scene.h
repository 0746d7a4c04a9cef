// Loads a scene file and builds its simulator.
#pragma once

#include "app/command_line.h"
#include "scene/building/scene_builder.h"
#include "scene/reading/scene_reader.h"

#include <string>
#include <vector>

namespace sprung {

struct LoadedScene {
  Scene scene;
  Simulator simulator;
  int frames = 1;
  int steps_per_frame = 1;
  double largest_stable_step = 0.0;  ///< [s]; infinity without a bound
  std::vector<NamedReport> meshes;
  std::vector<std::string> warnings;  ///< without duplicates
};

/// Throws FileError if the scene cannot be read, and InputError with every problem, each with its file.
[[nodiscard]] LoadedScene load_scene(const SceneOptions& options);

/// `8 steps of 0.00416667 s (automatic)`
[[nodiscard]] std::string describe_steps(const LoadedScene& loaded);

}  // namespace sprung
