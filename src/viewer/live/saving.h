// Saves a live run where a page may save: in one folder, under a name that the page chose.
#pragma once

#include <filesystem>
#include <string>

namespace sprung {

class LiveRun;

/// The path of a new folder, or with an `ending` such as ".html" of a new file, in a folder. Throws InputError if the name has more
/// than 64 characters or others than letters, digits, `_` and `-`, begins with `-`, or is taken.
[[nodiscard]] std::filesystem::path new_path(const std::filesystem::path& folder, const std::string& name,
                                             const std::string& ending = "");

/// Writes the frames of a run as one HTML file. Throws FileError.
void save_page(const LiveRun& run, const std::filesystem::path& file);

}  // namespace sprung
