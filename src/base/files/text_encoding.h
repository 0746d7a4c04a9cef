// Text files as programs save them: in UTF-8 or UTF-16, with or without a byte order mark.
#pragma once

#include <string>
#include <string_view>

namespace sprung {

/// The text in UTF-8, without a byte order mark. UTF-16 is known by its byte order mark, or by four ASCII characters of two bytes
/// each at the beginning. Halves of surrogate pairs become U+FFFD. All other bytes are returned as they are.
[[nodiscard]] std::string utf8_text(std::string bytes);

/// Whether a text of ASCII characters is in UTF-32, which utf8_text() returns as it is: by its byte order mark, or by its first
/// character, which has four bytes.
[[nodiscard]] bool is_utf32(std::string_view bytes);

}  // namespace sprung
