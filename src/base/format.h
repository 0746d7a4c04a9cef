// Numbers as text.
#pragma once

#include <cstddef>
#include <string>

namespace sprung {

/// Appends the shortest text that reads back as the same double; `nan`, `inf` or `-inf` if the value is not finite.
void append_number(std::string& text, double value);

[[nodiscard]] std::string format_number(double value);

/// Rounded to this number of significant digits, for display. Requires 1 <= digits <= 17.
[[nodiscard]] std::string format_number(double value, int digits);

/// An upper bound for users to type: rounded down to this number of significant digits, so that it exceeds `bound` by rounding
/// error at most. Requires bound > 0 and 1 <= digits <= 17.
[[nodiscard]] std::string format_upper_bound(double bound, int digits = 6);

/// The same for a lower bound: rounded up.
[[nodiscard]] std::string format_lower_bound(double bound, int digits = 6);

/// With small letters for the capital ones of ASCII.
[[nodiscard]] std::string lower_case(std::string text);

/// "1 spring", "2 springs".
[[nodiscard]] std::string counted(std::size_t count, const std::string& what);

/// "1 vertex", "2 vertices".
[[nodiscard]] std::string counted(std::size_t count, const std::string& one, const std::string& several);

}  // namespace sprung
