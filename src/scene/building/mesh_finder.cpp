#include "scene/building/mesh_finder.h"

#include "scene/format/file_wildcard.h"
#include "scene/json/near_file.h"
#include "scene/json/nearest_name.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::filesystem::is_directory(path, ignored);
}

}  // namespace

MeshFinder::MeshFinder(std::filesystem::path scene_file, const std::vector<std::filesystem::path>& mesh_paths)
    : scene_file_(std::move(scene_file)), folders_{scene_file_.parent_path()} {
  folders_.insert(folders_.end(), mesh_paths.begin(), mesh_paths.end());
}

std::optional<std::filesystem::path> MeshFinder::find(const std::string& file, const std::string& key,
                                                      std::vector<Problem>& problems) const {
  for (const std::filesystem::path& folder : folders_) {
    const std::filesystem::path candidate = folder / file;  // an absolute path replaces the folder
    if (is_file(candidate)) return candidate;
    std::error_code ignored;
    if (std::filesystem::is_directory(candidate, ignored)) {
      problems.push_back({scene_file_.string(), key, "\"" + file + "\"", "is a folder: " + candidate.string(),
                          "name a file in it; a sequence of meshes has a pattern such as " + file + "/*.obj"});
      return std::nullopt;
    }
  }
  report_missing(file, key, "no such file", problems);
  return std::nullopt;
}

std::vector<std::filesystem::path> MeshFinder::find_all(const std::string& pattern, const std::string& key,
                                                        std::vector<Problem>& problems) const {
  for (const std::filesystem::path& folder : folders_) {
    std::vector<std::filesystem::path> files = matching_files(folder / pattern);
    if (files.size() == 1) {
      problems.push_back({scene_file_.string(), key, "\"" + pattern + "\"", "matches one file only, " + files.front().string(),
                          "a sequence has at least 2; a mesh that does not deform is of type \"mesh\""});
      return {};
    }
    if (!files.empty()) return files;
  }
  report_missing(pattern, key, "no file matches", problems);
  return {};
}

void MeshFinder::report_missing(const std::string& file, const std::string& key, const std::string& rule,
                                std::vector<Problem>& problems) const {
  std::vector<std::string> looked;
  for (const std::filesystem::path& folder : folders_) {
    const std::filesystem::path candidate = folder / file;
    if (!looked.empty() && looked.back() == candidate.string()) continue;
    looked.push_back(candidate.string());
  }
  const auto near = near_file(folders_, file);
  problems.push_back({scene_file_.string(), key, "\"" + file + "\"", rule + ": looked for " + joined(looked),
                      (near ? "did you mean \"" + *near + "\"? Otherwise " : std::string()) +
                          (scene_file_.empty() ? "" : "put it beside the scene, or ") +
                          "name its folder with --mesh-path or SPRUNG_MESH_PATH"});
}

std::vector<std::filesystem::path> all_mesh_paths(const std::vector<std::string>& given) {
  std::vector<std::filesystem::path> folders(given.begin(), given.end());
  const char* value = std::getenv("SPRUNG_MESH_PATH");
  std::istringstream paths(value == nullptr ? "" : value);
  for (std::string folder; std::getline(paths, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

}  // namespace sprung
