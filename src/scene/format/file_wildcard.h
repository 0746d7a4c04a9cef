// Files by a pattern, in the order in which people number them.
#pragma once

#include <filesystem>
#include <optional>
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

/// Of files that are numbered where the pattern has its *, the first after which numbers are left out, seen from the least step
/// between two: wave.6.obj of 4, 6, 10. None when there is none, or they are not numbered.
[[nodiscard]] std::optional<std::filesystem::path> file_before_gap(const std::vector<std::filesystem::path>& files,
                                                                   const std::filesystem::path& pattern);

}  // namespace sprung
