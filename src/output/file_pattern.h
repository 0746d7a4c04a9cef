// Names of the files of a sequence: `banner/banner.####.obj` stands for banner.0001.obj, banner.0002.obj and so on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// `name.####.obj`, with as many `#` as the last frame's number has digits, and at least 4, so that names sort by
/// number.
[[nodiscard]] std::string sequence_pattern(const std::string& name, int frames);

/// The file of a frame. Requires a number >= 0 that has no more digits than the pattern has `#`.
[[nodiscard]] std::string fill_pattern(const std::string& pattern, int frame);

/// Whether the pattern names files below the folder it is relative to, by plain names.
[[nodiscard]] bool stays_inside(const std::string& pattern);

/// Files in `folder` that the pattern stands for (a pattern without `#` stands for one file), sorted. A folder that is a symbolic
/// link is not entered. Throws std::filesystem::filesystem_error when a folder cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace sprung
