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

 private:
  std::filesystem::path scene_file_;
  std::vector<std::filesystem::path> folders_;
};

}  // namespace sprung
