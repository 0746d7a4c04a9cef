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

/// `did you mean "x"?`, with the nearest name or, if `word` is one of the words that underscores join in up to three names, with
/// these: `did you mean "soft_x" or "hard_x"?`. Empty if there is none.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

/// did_you_mean() or, if that is empty, `choose from a, b, c`.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);

/// `a, b, c`
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

}  // namespace sprung
