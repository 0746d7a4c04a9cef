// Files that match a pattern, in natural order.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {

/// Natural order: digits count as numbers, so `wave.9.obj` comes before `wave.10.obj`.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

/// Whether the path has exactly one `*`, in its last component: `breath/breath.*.obj`.
[[nodiscard]] bool is_wildcard(std::string_view pattern);

/// The files that match the pattern, in natural order. Hidden files match only if the pattern begins with their dot. Requires
/// `is_wildcard(pattern)`.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::filesystem::path& pattern);

/// Finds a gap in files that are numbered at the * of the pattern: the first file whose distance to the next number exceeds the
/// smallest distance, for example wave.6.obj of 4, 6, 10. None if there is no gap or the files are not numbered.
[[nodiscard]] std::optional<std::filesystem::path> file_before_gap(const std::vector<std::filesystem::path>& files,
                                                                   const std::filesystem::path& pattern);

}  // namespace sprung
