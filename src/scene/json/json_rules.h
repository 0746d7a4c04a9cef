// Rules that convert JSON values to C++ values. Each checks the type and the bounds of a value and reports violations.
#pragma once

#include "base/types.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// A location in a file, and the list to which its problems are reported.
struct JsonLocation {
  std::string file;
  std::string path;
  std::vector<Problem>* problems = nullptr;
  std::size_t* unknown_keys = nullptr;  ///< counts the problems that are unknown keys; may be null

  [[nodiscard]] JsonLocation at(const std::string& key) const { return {file, join_path(path, key), problems, unknown_keys}; }
  [[nodiscard]] JsonLocation at(std::size_t index) const { return {file, join_path(path, index), problems, unknown_keys}; }
  void report(const Json& value, const std::string& rule, const std::string& remedy = {}) const;
  /// Reports a problem without a value, because there is none or it is too long.
  void report_key(const std::string& rule, const std::string& remedy = {}) const;
};

/// Reads a value, or reports the problem and returns none.
template <class T>
using Rule = std::function<std::optional<T>(Json&, const JsonLocation&)>;

/// Squares and cubes of larger numbers are useless in any unit.
inline constexpr double kLargestNumber = 1e30;

struct Range {
  double lower = -kLargestNumber;
  double upper = kLargestNumber;
  bool without_lower = false;
};
inline constexpr Range kPositive{0.0, kLargestNumber, true};
inline constexpr Range kNotNegative{0.0};
inline constexpr Range kFraction{0.0, 1.0};

[[nodiscard]] Rule<double> number(Range range = {});
/// Whole numbers; 64.0 is a whole number.
[[nodiscard]] Rule<Index> integer(Index lower, Index upper);
[[nodiscard]] Rule<bool> boolean();
/// A string that is not empty.
[[nodiscard]] Rule<std::string> text();
/// Remedies for words that are not allowed but likely, by word.
using WordRemedies = std::map<std::string, std::string>;
/// One of the words, as its index in the list.
[[nodiscard]] Rule<std::size_t> word_of(std::vector<std::string> words, WordRemedies remedies = {});
[[nodiscard]] Rule<Vector3> vector3(Range range = {});

namespace detail {
[[nodiscard]] bool check_list(const Json& json, const JsonLocation& location, std::size_t least, std::size_t most);
}  // namespace detail

/// An array of `least` to `most` entries.
template <class T>
[[nodiscard]] Rule<std::vector<T>> list_of(Rule<T> rule, std::size_t least, std::size_t most = 100'000'000) {
  return [=](Json& json, const JsonLocation& location) -> std::optional<std::vector<T>> {
    if (!detail::check_list(json, location, least, most)) return std::nullopt;
    std::vector<T> values;
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (auto value = rule(json[i], location.at(i))) values.push_back(std::move(*value));
    }
    if (values.size() != json.size()) return std::nullopt;
    return values;
  };
}

/// An array of exactly n entries.
template <std::size_t n, class T>
[[nodiscard]] Rule<std::array<T, n>> array_of(Rule<T> rule) {
  return [list = list_of<T>(std::move(rule), n, n)](Json& json, const JsonLocation& location) -> std::optional<std::array<T, n>> {
    const auto values = list(json, location);
    if (!values) return std::nullopt;
    std::array<T, n> result{};
    std::copy(values->begin(), values->end(), result.begin());
    return result;
  };
}

}  // namespace sprung
