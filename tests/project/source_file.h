// The sources of src/ as the project's tests read them: folder, name and #include lines.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sprung::project {

struct Include {
  std::string path;
  bool quoted = false;  ///< "path", as ours are; <path> otherwise
};

struct SourceFile {
  std::string path;    ///< from src/, as "network/model/spring_network.h"
  std::string folder;  ///< the first part of its path
  std::vector<Include> includes;

  [[nodiscard]] bool is_header() const { return path.ends_with(".h"); }
};

[[nodiscard]] SourceFile parse_source(const std::string& path, const std::string& text);

/// Every .h and .cpp under a folder, sorted by path.
[[nodiscard]] std::vector<SourceFile> read_sources(const std::filesystem::path& root);

}  // namespace sprung::project
