// Explains where and why the JSON parser stopped.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace sprung {

/// The most likely mistake, with its line and column as `key` and without the file. `position` is the number of characters that
/// the parser has read. The last of them ended `token`, the last string or number and what followed it.
[[nodiscard]] Problem syntax_problem(std::string_view text, std::size_t position, const std::string& token);

/// For a NUL byte at `position`.
[[nodiscard]] Problem nul_problem(std::string_view text, std::size_t position);

/// As syntax_problem(), for `token`, a number too large for a double.
[[nodiscard]] Problem overflow_problem(std::string_view text, std::size_t position, const std::string& token);

}  // namespace sprung
