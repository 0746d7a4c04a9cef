#include "python/simulator/scene_origin.h"

#include "base/error.h"
#include "python/simulator/interpreter.h"
#include "scene/building/mesh_finder.h"

#include <pybind11/pybind11.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sprung::python {
namespace {

void replace(std::string& text, std::string_view option, std::string_view argument) {
  const std::size_t at = text.find(option);
  if (at != std::string::npos) text.replace(at, option.size(), argument);
}

}  // namespace

LoadedScene load_in_python(const SceneSource& source) try {
  const WithoutLock without_lock;
  PreparedScene prepared = prepare_scene(source);
  prepared.built.settings.record_contact_forces = prepared.built.settings.record_forces;
  return start_scene(std::move(prepared));
} catch (const InputError& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    replace(problem.file, "--set", "overrides");
    replace(problem.key, "--set", "overrides");
    replace(problem.remedy, "--set", "overrides");
    replace(problem.remedy, "--mesh-path", "mesh_paths");
  }
  throw InputError(std::move(problems));
}

std::shared_ptr<const SceneOrigin> origin_of(SceneSource source, const LoadedScene& loaded) {
  source.file = std::filesystem::absolute(source.file).string();  // of a dict too: its meshes are found in the folder
  std::vector<std::string> folders;
  for (const std::filesystem::path& folder : all_mesh_paths(source.mesh_paths)) {
    folders.push_back(std::filesystem::absolute(folder).string());
  }
  source.mesh_paths = std::move(folders);
  return std::make_shared<const SceneOrigin>(
      SceneOrigin{.source = std::move(source), .bodies = loaded.sources, .model = loaded.simulator.model()});
}

}  // namespace sprung::python
