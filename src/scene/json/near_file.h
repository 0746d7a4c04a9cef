// The file that was meant by a name that no file has.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// The existing file whose name is nearest to that of `missing`, a path relative to one of `folders`, in the form of `missing`:
/// of the files beside it; if none is near (see `nearest_name`), of those in the folders and one level below. `extension`, as
/// `.json`, limits the files to these; empty: all.
[[nodiscard]] std::optional<std::string> near_file(const std::vector<std::filesystem::path>& folders,
                                                   const std::filesystem::path& missing, const std::string& extension = "");

}  // namespace sprung
