// What is wrong where the JSON parser stopped.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace sprung {

/// The most likely mistake, its line and column as `key`, without the file. `position` is how many characters the parser had read,
/// the last of them the one that ended `token`, the last string or number and what followed it.
[[nodiscard]] Problem syntax_problem(std::string_view text, std::size_t position, const std::string& token);

/// The same for `token`, a number too large for a double.
[[nodiscard]] Problem overflow_problem(std::string_view text, std::size_t position, const std::string& token);

}  // namespace sprung
