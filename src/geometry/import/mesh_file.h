// Shared by all mesh readers: the format and bytes of a file, and a list of its problems.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// The problems of one file. Keeps the first twenty and counts the rest, so that the report on a badly damaged file stays
/// readable.
class FileProblems {
 public:
  explicit FileProblems(const std::filesystem::path& file) : file_(file.string()) {}

  void add(std::string location, std::string value, std::string rule, std::string remedy = "");

  /// Throws InputError with all problems, if there are any.
  void throw_if_any() const;

 private:
  std::string file_;
  std::vector<Problem> problems_;
  std::size_t left_out_ = 0;
};

/// The file's extension in lower case, with its dot: `.obj` for `CUBE.OBJ`.
[[nodiscard]] std::string lower_case_extension(const std::filesystem::path& file);

/// The whole file. Throws InputError if it is missing, is not a regular file, cannot be opened or is empty.
[[nodiscard]] std::string read_mesh_file(const std::filesystem::path& file);

/// The whole file, in UTF-8 without a byte order mark if it is text (`text_encoding.h`). Throws as `read_mesh_file` does.
[[nodiscard]] std::string read_mesh_text(const std::filesystem::path& file);

}  // namespace sprung
