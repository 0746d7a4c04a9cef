// Files by a pattern, in the order in which people number them.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace sprung {

/// Digits count as numbers: `wave.9.obj` comes before `wave.10.obj`.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

/// Whether it is a path with exactly one `*`, in its last part: `breath/breath.*.obj`.
[[nodiscard]] bool is_wildcard(std::string_view pattern);

/// The files that the pattern stands for, sorted naturally; hidden ones only where the pattern begins with their dot. Requires
/// `is_wildcard(pattern)`.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::filesystem::path& pattern);

}  // namespace sprung
