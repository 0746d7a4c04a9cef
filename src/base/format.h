// Numbers as text: the shortest that reads back to the same double.
#pragma once

#include <cstddef>
#include <string>

namespace sprung {

/// Appends the shortest text that reads back to the same double; `nan`, `inf`, `-inf` for what is not finite.
void append_number(std::string& text, double value);

[[nodiscard]] std::string format_number(double value);

/// Rounded to so many significant digits: for people. Requires 1 <= digits <= 17.
[[nodiscard]] std::string format_number(double value, int digits);

/// A bound that people may type: rounded to six significant digits, but never above `bound` by more than rounding. Requires bound >
/// 0.
[[nodiscard]] std::string format_upper_bound(double bound);

/// "1 spring", "2 springs".
[[nodiscard]] std::string counted(std::size_t count, const std::string& what);

}  // namespace sprung
