// The folder of a run: refused when it holds something, written file by file, each under a temporary name first.
#pragma once

#include <filesystem>
#include <string>

namespace sprung {

class OutputFolder {
 public:
  /// Makes the folder. Throws FileError when it cannot be made or written, or when it is not empty; with `overwrite` what an
  /// earlier run wrote there is removed, and nothing else.
  OutputFolder(std::filesystem::path folder, bool overwrite);

  /// Writes a whole file, given relative to the folder, under a temporary name and renames it. Throws FileError; then nothing of
  /// the file remains.
  void write(const std::filesystem::path& file, const std::string& text) const;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace sprung
