// Checks the scenes of a sweep before it begins, and whether they stay the same.
#pragma once

#include "scene/load_scene.h"
#include "sweep/sweep_folder.h"
#include "sweep/sweep_plan.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace sprung {

// A scene takes about a millisecond to check.
inline constexpr std::size_t kMostChecked = 1000;

/// Checks each value of each key once, together with the first value of the others, so that nothing is written for a sweep with a
/// misspelt key. Of many values of a key, as of samples, only the first `most`. Returns the resolved scene of the first run, JSON
/// text. Throws InputError with every problem of the text, and FileError if the scene cannot be read.
[[nodiscard]] std::string checked_scene(const SceneSource& scene, const SweepRequest& request, std::size_t most = kMostChecked);

/// Throws InputError if the meshes or bodies of the first and of the last run are refused: then the fault is hardly of their
/// values.
void check_meshes_and_bodies(const SweepFolder& sweep);

/// Notes when the scene file changes while its sweep goes on.
class SceneWatch {
 public:
  /// Keeps a reference to the sweep.
  explicit SceneWatch(const SweepFolder& sweep) : sweep_(sweep) {}

  /// Reads the scene if its file has a new time. Throws InputError with the differences if it is another one, and FileError if it
  /// cannot be read.
  void check();

 private:
  const SweepFolder& sweep_;
  std::optional<std::filesystem::file_time_type> seen_{};
};

}  // namespace sprung
