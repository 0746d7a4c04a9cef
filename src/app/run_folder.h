// The folder of a run that a command was given.
#pragma once

#include <filesystem>
#include <string>

namespace sprung {

class RecordedRun;

/// Throws FileError that names a similar file or folder if there is neither a file nor a folder of this name.
void check_exists(const std::string& target);

/// An export may replace an earlier export in the folder of a run, and no other file of the run. Throws FileError.
void check_replaces_no_file_of_run(const std::filesystem::path& file, const std::filesystem::path& run);

/// Warns of what the files of the run lack.
void warn_of_missing(const RecordedRun& run);

}  // namespace sprung
