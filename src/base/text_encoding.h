// Text files as programs save them: in UTF-8 or UTF-16, with or without a byte order mark.
#pragma once

#include <string>

namespace sprung {

/// The text in UTF-8, without a byte order mark. UTF-16 is known by its byte order mark, or by four ASCII characters of two bytes
/// each at the beginning. Halves of surrogate pairs become U+FFFD. All other bytes are returned as they are.
[[nodiscard]] std::string utf8_text(std::string bytes);

}  // namespace sprung
