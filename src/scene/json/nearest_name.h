// "Did you mean ...?"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// The name with the fewest edits from `word` (insert, remove, replace, swap neighbours; Damerau 1964), if these are at most a
/// third of its letters, or two. Also a name that begins with `word`, or with which `word` begins. Ignores case.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word, const std::vector<std::string>& names);

/// `did you mean "x"?` or, if no name is near, `choose from a, b, c`.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);

/// `a, b, c`
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

}  // namespace sprung
