// Words and numbers of text formats.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {

[[nodiscard]] inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Splits a line at blanks. Reuses the memory of `words`.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// The number that the whole word spells, in C notation with an optional plus. None if it is not a number or out of range of the
/// type. `nan` and `inf` are numbers.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// Removes the first line from `text` and returns it without its end: a line feed, a carriage return, or both.
[[nodiscard]] std::string_view take_line(std::string_view& text);

}  // namespace sprung
