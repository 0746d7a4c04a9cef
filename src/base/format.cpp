#include "base/format.h"

#include <array>
#include <charconv>
#include <cmath>

namespace sprung {
namespace {

constexpr double kRounding = 1.0e-12;

double unit_of_last_digit(double value, int digits) { return std::pow(10.0, std::floor(std::log10(value)) - (digits - 1)); }

}  // namespace

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

std::string format_upper_bound(double bound, int digits) {
  if (!std::isfinite(bound)) return format_number(bound);
  const double unit = unit_of_last_digit(bound, digits);
  return format_number(std::floor(bound / unit * (1.0 + kRounding)) * unit, digits);
}

std::string format_lower_bound(double bound, int digits) {
  if (!std::isfinite(bound)) return format_number(bound);
  const double unit = unit_of_last_digit(bound, digits);
  return format_number(std::ceil(bound / unit * (1.0 - kRounding)) * unit, digits);
}

std::string lower_case(std::string text) {
  for (char& letter : text) letter = 'A' <= letter && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  return text;
}

std::string counted(std::size_t count, const std::string& what) { return counted(count, what, what + "s"); }

std::string counted(std::size_t count, const std::string& one, const std::string& several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

}  // namespace sprung
