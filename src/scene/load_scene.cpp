#include "scene/load_scene.h"

#include "base/error.h"
#include "scene/building/mesh_finder.h"
#include "scene/reading/scene_reader.h"
#include "simulation/start/start_check.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

namespace sprung {
namespace {

void add_new(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& text : more) {
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  }
}

/// Pieces of a mesh that touch are no reason to change its shape.
[[noreturn]] void refuse_start(const InputError& error, const std::map<std::string, std::string>& weld_remedies) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    for (const auto& [body, remedy] : weld_remedies) {
      if (problem.key == "bodies." + body && problem.rule.starts_with(kIntersectsItself)) problem.remedy = remedy;
    }
  }
  throw InputError(std::move(problems));
}

Simulator start(BuiltScene& built) try {
  return {std::move(built.network), built.settings, std::move(built.obstacles), built.start};
} catch (const InputError& error) {
  refuse_start(error, built.weld_remedies);
}

/// Calls `function`; problems without a file get this one.
template <class Function>
auto with_file(const std::string& file, const Function& function) try {
  return function();
} catch (const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    if (problem.file.empty()) problem.file = file;
  }
  throw InputError(std::move(problems));
}

}  // namespace

std::string scene_text(const SceneSource& source) { return source.text ? *source.text : read_scene_file(source.file); }

PreparedScene prepare_scene(const SceneSource& source) {
  return with_file(source.file, [&] {
    TextProblems problems;
    Scene scene = read_scene_text(scene_text(source), source.file, source.overrides, problems);
    BuiltScene built = build_scene(scene, all_mesh_paths(source.mesh_paths), problems);
    return PreparedScene{.file = source.file, .scene = std::move(scene), .built = std::move(built)};
  });
}

LoadedScene start_scene(PreparedScene prepared) {
  BuiltScene& built = prepared.built;
  return with_file(prepared.file, [&] {
    LoadedScene loaded{.scene = std::move(prepared.scene),
                       .simulator = start(built),
                       .frames = built.frames,
                       .largest_stable_step = built.largest_stable_step,
                       .meshes = std::move(built.meshes),
                       .initial_state = std::move(built.initial_state),
                       .sources = std::move(built.sources),
                       .adjustments = std::move(built.adjustments),
                       .warnings = {}};
    add_new(loaded.warnings, built.warnings);
    add_new(loaded.warnings, loaded.simulator.warnings());
    return loaded;
  });
}

LoadedScene load_scene(const SceneSource& source) { return start_scene(prepare_scene(source)); }

}  // namespace sprung
