// The lines of an OBJ or MTL file as places in its text. Internal to geometry/obj_source.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace sprung {

/// A part [begin, end) of a text.
struct TextRange {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

/// A line with those that continue it after a backslash.
struct ObjLine {
  TextRange whole;               ///< with its end
  std::size_t line_end = 0;      ///< where its end begins: a line feed, a carriage return, or both
  std::vector<TextRange> words;  ///< without comments

  [[nodiscard]] std::string_view word(std::string_view text, std::size_t number) const {
    return number < words.size() ? words[number].of(text) : std::string_view();
  }
};

/// Reads the line that begins at `begin`, as `plain_obj_text` does. Reuses the memory of `line`. Requires begin < text.size().
void read_obj_line(std::string_view text, std::size_t begin, ObjLine& line);

}  // namespace sprung
