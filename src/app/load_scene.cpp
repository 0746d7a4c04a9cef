#include "app/load_scene.h"

#include "base/error.h"
#include "base/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace sprung {
namespace {

constexpr int kDigits = 6;

std::vector<std::filesystem::path> mesh_paths(const SceneOptions& options) {
  std::vector<std::filesystem::path> paths(options.mesh_paths.begin(), options.mesh_paths.end());
  const std::vector<std::filesystem::path> more = mesh_paths_from_environment();
  paths.insert(paths.end(), more.begin(), more.end());
  return paths;
}

void add_new(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& text : more) {
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  }
}

LoadedScene load(const SceneOptions& options) {
  TextProblems problems;
  Scene scene = read_scene(options.file, options.overrides, problems);
  BuiltScene built = build_scene(scene, mesh_paths(options), problems);
  LoadedScene loaded{.scene = std::move(scene),
                     .simulator = Simulator(std::move(built.network), built.settings, std::move(built.obstacles)),
                     .frames = built.frames,
                     .steps_per_frame = built.steps_per_frame,
                     .largest_stable_step = built.largest_stable_step,
                     .meshes = std::move(built.meshes),
                     .warnings = {}};
  add_new(loaded.warnings, built.warnings);
  add_new(loaded.warnings, loaded.simulator.warnings());
  return loaded;
}

}  // namespace

LoadedScene load_scene(const SceneOptions& options) try { return load(options); } catch (const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    if (problem.file.empty()) problem.file = options.file;
  }
  throw InputError(std::move(problems));
}

std::string describe_steps(const LoadedScene& loaded) {
  return fmt::format("{} of {} s ({})", counted(loaded.steps_per_frame, "step"),
                     format_number(loaded.simulator.settings().step, kDigits), loaded.scene.step ? "as given" : "automatic");
}

}  // namespace sprung
