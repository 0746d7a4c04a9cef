// The folder of a run: refused when it holds something, written file by file, each under a temporary name first.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// What a run may remove is told by the run.json of the run before: it lists the patterns of all files that the run was going to
/// write, and is the first file written and the last removed. So a run that was killed can be overwritten too, and a file that
/// no pattern names is never touched.
class OutputFolder {
 public:
  /// Makes the folder. Throws FileError when it cannot be made or read, or when it is not empty; with `overwrite` what an earlier
  /// run wrote there is removed, and nothing else, and a folder that holds no run is refused all the same.
  OutputFolder(std::filesystem::path folder, bool overwrite);

  /// Throws FileError when a file that one of the patterns stands for is there already; see `file_pattern.h`.
  void expect_free(const std::vector<std::string>& patterns) const;

  /// Writes a whole file, given relative to the folder, under a temporary name and renames it. Throws FileError; then nothing of
  /// the file remains.
  void write(const std::filesystem::path& file, const std::string& text) const;

  /// Appends to a file, given relative to the folder. Throws FileError; then the file is as before.
  void append(const std::filesystem::path& file, const std::string& text) const;

  /// Removes a file, given relative to the folder, if it is there.
  void remove(const std::filesystem::path& file) const noexcept;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace sprung
