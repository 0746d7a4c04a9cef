// What every mesh reader needs of a file: its format, its bytes, and a list of what is wrong with it.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// The problems of one file. The first twenty are kept, the rest are only counted, so that a broken scan stays readable.
class FileProblems {
 public:
  explicit FileProblems(const std::filesystem::path& file) : file_(file.string()) {}

  void add(std::string place, std::string value, std::string rule, std::string remedy = "");

  /// Throws InputError with all of them.
  void throw_if_any() const;

 private:
  std::string file_;
  std::vector<Problem> problems_;
  std::size_t left_out_ = 0;
};

/// The file's extension with its dot, A to Z as a to z: `.obj` of `CUBE.OBJ`.
[[nodiscard]] std::string lower_case_extension(const std::filesystem::path& file);

/// The whole file. Throws InputError when it is missing, is no regular file, cannot be opened, or is empty.
[[nodiscard]] std::string read_mesh_file(const std::filesystem::path& file);

}  // namespace sprung
