// Rules that turn JSON values into C++ ones: each names type and bounds of a value, and reports what breaks them.
#pragma once

#include "base/types.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// Where in which file, and who is told of problems.
struct JsonPlace {
  std::string file;
  std::string path;
  std::vector<Problem>* problems = nullptr;
  std::size_t* unknown_keys = nullptr;  ///< how many of the problems are keys that nobody knows; may be left out

  [[nodiscard]] JsonPlace at(const std::string& key) const { return {file, join_path(path, key), problems, unknown_keys}; }
  [[nodiscard]] JsonPlace at(std::size_t index) const { return {file, join_path(path, index), problems, unknown_keys}; }
  void report(const Json& value, const std::string& rule, const std::string& remedy = {}) const;
  /// When there is no value to show, or too much of it.
  void report_key(const std::string& rule, const std::string& remedy = {}) const;
};

/// Reads a value, or reports why it cannot and returns none.
template <class T>
using Rule = std::function<std::optional<T>(Json&, const JsonPlace&)>;

/// Beyond this a number's square or cube is no longer of use, whatever its unit.
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
/// Whole numbers; 64.0 is one.
[[nodiscard]] Rule<Index> integer(Index lower, Index upper);
[[nodiscard]] Rule<bool> boolean();
/// A string that is not empty.
[[nodiscard]] Rule<std::string> text();
/// One of the words, as its number in the list.
[[nodiscard]] Rule<std::size_t> word_of(std::vector<std::string> words);
[[nodiscard]] Rule<Vector3> vector3(Range range = {});

namespace detail {
[[nodiscard]] bool check_list(const Json& json, const JsonPlace& place, std::size_t least, std::size_t most);
}  // namespace detail

/// An array of `least` to `most` entries.
template <class T>
[[nodiscard]] Rule<std::vector<T>> list_of(Rule<T> rule, std::size_t least, std::size_t most = 100'000'000) {
  return [=](Json& json, const JsonPlace& place) -> std::optional<std::vector<T>> {
    if (!detail::check_list(json, place, least, most)) return std::nullopt;
    std::vector<T> values;
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (auto value = rule(json[i], place.at(i))) values.push_back(std::move(*value));
    }
    if (values.size() != json.size()) return std::nullopt;
    return values;
  };
}

/// An array of exactly n entries.
template <std::size_t n, class T>
[[nodiscard]] Rule<std::array<T, n>> array_of(Rule<T> rule) {
  return [list = list_of<T>(std::move(rule), n, n)](Json& json, const JsonPlace& place) -> std::optional<std::array<T, n>> {
    const auto values = list(json, place);
    if (!values) return std::nullopt;
    std::array<T, n> result{};
    std::copy(values->begin(), values->end(), result.begin());
    return result;
  };
}

}  // namespace sprung
