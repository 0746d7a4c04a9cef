// Where the meshes of a scene are.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class MeshFinder {
 public:
  /// Looks beside the scene file, then in `mesh_paths`, in their order.
  MeshFinder(std::filesystem::path scene_file, const std::vector<std::filesystem::path>& mesh_paths);

  /// The file that the scene names under `key`; when there is none, adds a problem that says where it was looked for.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& file, const std::string& key,
                                                          std::vector<Problem>& problems) const;

  /// The files of the first folder that has any that match the pattern, sorted naturally; when none has two or more, adds a problem
  /// and returns none. Requires `is_wildcard(pattern)`.
  [[nodiscard]] std::vector<std::filesystem::path> find_all(const std::string& pattern, const std::string& key,
                                                            std::vector<Problem>& problems) const;

 private:
  void report_missing(const std::string& file, const std::string& key, const std::string& rule,
                      std::vector<Problem>& problems) const;

  std::filesystem::path scene_file_;
  std::vector<std::filesystem::path> folders_;
};

}  // namespace sprung
