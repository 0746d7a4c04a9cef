// The output folder of a run. Files of an earlier run are removed only on request, and no other files ever.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// A run removes only files that match the patterns in the run.json of the earlier run. run.json lists the patterns of all files
/// that the run will write; it is the first file written and the last removed. So a killed run can be overwritten, and a file that
/// matches no pattern is never removed.
class OutputFolder {
 public:
  /// Creates the folder. Throws FileError if it cannot be created or read, or if it is not empty. With `overwrite`, removes the
  /// files of the earlier run instead; throws FileError if the folder has files but no run.
  OutputFolder(std::filesystem::path folder, bool overwrite);

  /// Throws FileError if a file exists that matches one of the patterns (see `file_pattern.h`).
  void expect_free(const std::vector<std::string>& patterns) const;

  /// Writes a file (path relative to the folder) under a temporary name and renames it. Throws FileError; no part of the file then
  /// remains.
  void write(const std::filesystem::path& file, const std::string& text) const;

  /// Appends to a file (path relative to the folder). Returns its size before. Throws FileError; the file is then unchanged.
  std::uintmax_t append(const std::filesystem::path& file, const std::string& text) const;

  /// Takes an append back: shortens a file (path relative to the folder) to a size, if possible.
  void shorten(const std::filesystem::path& file, std::uintmax_t size) const noexcept;

  /// Removes a file (path relative to the folder) if it exists.
  void remove(const std::filesystem::path& file) const noexcept;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace sprung
