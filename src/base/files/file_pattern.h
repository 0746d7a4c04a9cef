// Names of the files of a sequence: `banner/banner.####.obj` means banner.0001.obj, banner.0002.obj, ...
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// `name.####` and the ending, with as many `#` as the number of frames has digits, at least 4. File names then sort by frame
/// number.
[[nodiscard]] std::string sequence_pattern(const std::string& name, int frames, const std::string& ending = ".obj");

/// The file name of a frame. Requires frame >= 0. A number with more digits than the pattern has `#` takes more room.
[[nodiscard]] std::string fill_pattern(const std::string& pattern, int frame);

/// Whether a body or an obstacle of this name can have a folder: it consists of letters, digits, `_` and `-`.
[[nodiscard]] bool is_folder_name(const std::string& name);

/// Whether the pattern is a relative path without `.` and `..`, so that its files lie below the folder.
[[nodiscard]] bool stays_inside(const std::string& pattern);

/// Existing files in `folder` that match the pattern, sorted. A pattern without `#` matches one file. Symbolic links to folders are
/// not followed. Throws std::filesystem::filesystem_error when a folder cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace sprung
