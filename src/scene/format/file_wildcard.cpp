#include "scene/format/file_wildcard.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <numeric>
#include <string>
#include <system_error>

namespace sprung {
namespace {

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Removes the number at the beginning of `text` and returns it without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// The number at the * of the pattern.
std::optional<std::int64_t> number_of(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  name.remove_prefix(star);
  name.remove_suffix(pattern.size() - star - 1);
  std::int64_t number = 0;
  const auto end = std::from_chars(name.data(), name.data() + name.size(), number);
  if (name.empty() || end.ec != std::errc{} || end.ptr != name.data() + name.size()) return std::nullopt;
  return number;
}

bool matches(std::string_view name, std::string_view before, std::string_view after) {
  if (before.empty() && name.starts_with('.')) return false;
  return name.size() >= before.size() + after.size() && name.starts_with(before) && name.ends_with(after);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view x = a;
  std::string_view y = b;
  while (!x.empty() && !y.empty()) {
    if (is_digit(x.front()) && is_digit(y.front())) {
      const std::string_view i = take_number(x);
      const std::string_view j = take_number(y);
      if (i.size() != j.size()) return i.size() < j.size();
      if (i != j) return i < j;
      continue;
    }
    if (x.front() != y.front()) return x.front() < y.front();
    x.remove_prefix(1);
    y.remove_prefix(1);
  }
  if (x.empty() != y.empty()) return x.empty();
  return a < b;  // `1` and `01`
}

bool is_wildcard(std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return false;
  return pattern.find_first_of("*/", star + 1) == std::string_view::npos;
}

std::vector<std::filesystem::path> matching_files(const std::filesystem::path& pattern) {
  const std::string name = pattern.filename().string();
  const std::size_t star = name.find('*');
  std::vector<std::filesystem::path> files;
  std::error_code error;  // a folder that does not exist or cannot be read has no files
  const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!matches(entry->path().filename().string(), std::string_view(name).substr(0, star),
                 std::string_view(name).substr(star + 1))) {
      continue;
    }
    std::error_code ignored;
    if (!entry->is_directory(ignored)) files.push_back(pattern.parent_path() / entry->path().filename());
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return natural_less(a.string(), b.string()); });
  return files;
}

std::optional<std::filesystem::path> file_before_gap(const std::vector<std::filesystem::path>& files,
                                                     const std::filesystem::path& pattern) {
  std::vector<std::int64_t> numbers;
  for (const std::filesystem::path& file : files) {
    const auto number = number_of(file.filename().string(), pattern.filename().string());
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  std::vector<std::int64_t> steps(numbers.size());
  std::adjacent_difference(numbers.begin(), numbers.end(), steps.begin());
  if (steps.size() < 2) return std::nullopt;
  const std::int64_t least = *std::min_element(steps.begin() + 1, steps.end());
  const auto gap = std::find_if(steps.begin() + 1, steps.end(), [&](std::int64_t step) { return step > least; });
  if (least <= 0 || gap == steps.end()) return std::nullopt;
  return files[static_cast<std::size_t>(gap - steps.begin()) - 1];
}

}  // namespace sprung
