// The output folder of a run. Files of an earlier run are removed only on request, and no other files ever.
#pragma once

#include "output/folder_lock.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// A run removes only files that match the patterns in the run.json of the earlier run. run.json lists the patterns of all files
/// that the run will write; it is the first file written and the last removed. So a killed run can be overwritten, and a file that
/// matches no pattern is never removed. While it lives, no other process can make one of the same folder.
class OutputFolder {
 public:
  /// Creates the folder. Throws FileError if it cannot be created or read, if another process writes a run into it, or if it is not
  /// empty. With `overwrite`, removes the files of the earlier run instead; throws FileError if the folder has files but no run.
  OutputFolder(std::filesystem::path folder, bool overwrite);

  /// The folder as it is, to go on with its run; creates it if it is missing. Throws FileError if it cannot be created or read, or
  /// if another process writes a run into it.
  [[nodiscard]] static OutputFolder as_it_is(std::filesystem::path folder);

  /// Removes the files of the run. Throws FileError if the folder has files but no run.
  void remove_run() const;

  /// Whether it has no files.
  [[nodiscard]] bool is_empty() const;

  /// Throws FileError if a file exists that matches one of the patterns (see `file_pattern.h`).
  void expect_free(const std::vector<std::string>& patterns) const;

  // Paths of files are relative to the folder.

  /// Writes a file under a temporary name and renames it. Throws FileError; no part of the file then
  /// remains.
  void write(const std::filesystem::path& file, const std::string& text) const;

  /// Appends to a file. Returns its size before. Throws FileError; the file is then unchanged.
  std::uintmax_t append(const std::filesystem::path& file, const std::string& text) const;

  /// Takes an append back: shortens a file to a size, if possible.
  void shorten(const std::filesystem::path& file, std::uintmax_t size) const noexcept;

  /// Shortens a file that is longer. Throws FileError if it cannot be shortened.
  void cut(const std::filesystem::path& file, std::uintmax_t size) const;

  /// The size of a file [bytes]; 0 if there is none.
  [[nodiscard]] std::uintmax_t size(const std::filesystem::path& file) const noexcept;

  /// Removes a file if it exists.
  void remove(const std::filesystem::path& file) const noexcept;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  explicit OutputFolder(std::filesystem::path folder);

  std::filesystem::path folder_;
  FolderLock lock_;
};

}  // namespace sprung
