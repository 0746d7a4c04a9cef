#include "scene/json/json_rules.h"

#include "base/format.h"
#include "scene/json/nearest_name.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

std::string describe(const Range& range) {
  const std::string lower = format_number(range.lower);
  if (range.upper < kLargestNumber) return "must be between " + lower + " and " + format_number(range.upper);
  return (range.without_lower ? "must be greater than " : "must be at least ") + lower;
}

bool is_whole(const Json& json) { return json.is_number() && std::floor(json.get<double>()) == json.get<double>(); }

}  // namespace

void JsonLocation::report(const Json& value, const std::string& rule, const std::string& remedy) const {
  problems->push_back({file, path, shortened(value), rule, remedy});
}

void JsonLocation::report_key(const std::string& rule, const std::string& remedy) const {
  problems->push_back({file, path, "", rule, remedy});
}

Rule<double> number(Range range) {
  return [=](Json& json, const JsonLocation& location) -> std::optional<double> {
    if (!json.is_number()) {
      location.report(json, "must be a number");
      return std::nullopt;
    }
    const double value = json.get<double>();
    if (std::abs(value) > kLargestNumber) {
      location.report(json, "must be at most " + format_number(kLargestNumber) + " in magnitude");
      return std::nullopt;
    }
    if (value < range.lower || value > range.upper || (range.without_lower && value == range.lower)) {
      location.report(json, describe(range));
      return std::nullopt;
    }
    return value;
  };
}

Rule<Index> integer(Index lower, Index upper) {
  return [=](Json& json, const JsonLocation& location) -> std::optional<Index> {
    if (!is_whole(json)) {
      location.report(json, "must be a whole number");
      return std::nullopt;
    }
    const double value = json.get<double>();
    if (value < lower || value > upper) {
      const std::string bound = lower == upper ? "must be " : value < lower ? "must be at least " : "must be at most ";
      location.report(json, bound + std::to_string(value < lower ? lower : upper));
      return std::nullopt;
    }
    json = static_cast<Index>(value);
    return json.get<Index>();
  };
}

Rule<bool> boolean() {
  return [](Json& json, const JsonLocation& location) -> std::optional<bool> {
    if (json.is_boolean()) return json.get<bool>();
    location.report(json, "must be true or false");
    return std::nullopt;
  };
}

Rule<std::string> text() {
  return [](Json& json, const JsonLocation& location) -> std::optional<std::string> {
    if (json.is_string() && !json.get_ref<const std::string&>().empty()) return json.get<std::string>();
    location.report(json, json.is_string() ? "must not be empty" : "must be a string");
    return std::nullopt;
  };
}

Rule<std::size_t> word_of(std::vector<std::string> words, WordRemedies remedies) {
  return [words = std::move(words), remedies = std::move(remedies)](Json& json,
                                                                    const JsonLocation& location) -> std::optional<std::size_t> {
    const std::string rule = words.size() == 1 ? "must be \"" + words.front() + "\"" : "must be one of " + joined(words);
    if (!json.is_string()) {
      location.report(json, rule);
      return std::nullopt;
    }
    const auto& word = json.get_ref<const std::string&>();
    const auto found = std::find(words.begin(), words.end(), word);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    const auto remedy = remedies.find(word);
    location.report(json, rule, remedy != remedies.end() ? remedy->second : did_you_mean(word, words));
    return std::nullopt;
  };
}

Rule<Vector3> vector3(Range range) {
  return [rule = array_of<3>(number(range))](Json& json, const JsonLocation& location) -> std::optional<Vector3> {
    const auto values = rule(json, location);
    if (!values) return std::nullopt;
    return Vector3((*values)[0], (*values)[1], (*values)[2]);
  };
}

namespace detail {

bool check_list(const Json& json, const JsonLocation& location, std::size_t least, std::size_t most) {
  const std::string entries = std::to_string(least) + (least == 1 ? " entry" : " entries");
  const std::string number = (least == most ? "" : "at least ") + entries;
  if (!json.is_array()) {
    location.report(json, "must be a list" + (least > 0 ? " of " + number : "") + ", written in [ ]");
    return false;
  }
  if (json.size() >= least && json.size() <= most) return true;
  location.report(json, "must have " + number, "it has " + std::to_string(json.size()));
  return false;
}

}  // namespace detail

}  // namespace sprung
