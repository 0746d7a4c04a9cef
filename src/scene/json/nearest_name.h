// "Did you mean ...?"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// The name that takes the fewest edits (insert, remove, replace, swap neighbours; Damerau 1964) to become `word`, if that is at
/// most a third of its letters, or two; or one that begins as the word does or the other way round. Upper and lower case are the
/// same.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word, const std::vector<std::string>& names);

/// `did you mean "x"?` or, when nothing is near, `choose from a, b, c`.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);

/// `a, b, c`
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

}  // namespace sprung
