#include "base/format.h"

#include <array>
#include <charconv>

namespace sprung {

void append_number(std::string& text, double value) {
  std::array<char, 32> buffer{};  // the longest shortest double has 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), end.ptr);
}

std::string format_number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string format_number(double value, int digits) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits);
  return {buffer.data(), end.ptr};
}

}  // namespace sprung
