// Finds the mesh files of a scene.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class MeshFinder {
 public:
  /// Looks beside the scene file, then in `mesh_paths`, in this order. Without a scene file (an empty path), first where the
  /// program runs.
  MeshFinder(std::filesystem::path scene_file, const std::vector<std::filesystem::path>& mesh_paths);

  /// The file that the scene names under `key`. If it does not exist, adds a problem with the paths that were tried.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& file, const std::string& key,
                                                          std::vector<Problem>& problems) const;

  /// The files that match the pattern in the first folder with any match, in natural order. If there are fewer than two, adds a
  /// problem and returns none. Requires `is_wildcard(pattern)`.
  [[nodiscard]] std::vector<std::filesystem::path> find_all(const std::string& pattern, const std::string& key,
                                                            std::vector<Problem>& problems) const;

 private:
  void report_missing(const std::string& file, const std::string& key, const std::string& rule,
                      std::vector<Problem>& problems) const;

  std::filesystem::path scene_file_;
  std::vector<std::filesystem::path> folders_;
};

/// The folders `given`, then those of the environment variable SPRUNG_MESH_PATH, which are separated by colons.
[[nodiscard]] std::vector<std::filesystem::path> all_mesh_paths(const std::vector<std::string>& given);

}  // namespace sprung
