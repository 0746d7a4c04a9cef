#include "sweep/sweep_plan.h"

#include "base/files/fingerprint.h"
#include "base/format.h"
#include "base/random.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace sprung {
namespace {

constexpr double kLargestInteger = 9007199254740992.0;  // 2^53: beyond it, not every integer is a double

struct Distribution {
  std::string name;
  double first = 0.0;   ///< lower bound, or mean
  double second = 0.0;  ///< upper bound, or standard deviation
};

constexpr const char* kForms = "write KEY=uniform(a,b), log_uniform(a,b), integer(a,b) or normal(mean,deviation)";

std::optional<double> number_of(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  double number = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// `uniform(1,2)`
std::optional<Distribution> read_distribution(std::string_view text) {
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || !text.ends_with(')')) return std::nullopt;
  const std::vector<std::string> arguments = split_values(text.substr(open + 1, text.size() - open - 2));
  if (arguments.size() != 2) return std::nullopt;
  const auto first = number_of(arguments[0]);
  const auto second = number_of(arguments[1]);
  Distribution distribution{std::string(text.substr(0, open)), first.value_or(0.0), second.value_or(0.0)};
  const std::vector<std::string> names{"uniform", "log_uniform", "integer", "normal"};
  const bool good = first && second && std::ranges::find(names, distribution.name) != names.end();
  return good ? std::optional(std::move(distribution)) : std::nullopt;
}

/// The problem with the arguments of a distribution, or an empty rule.
Problem check(const Distribution& distribution) {
  const auto [name, first, second] = distribution;
  if (name == "normal") {
    if (second > 0.0) return {};
    return {.rule = "the standard deviation must be greater than 0", .remedy = "give one, or use --vary for a single value"};
  }
  if (!(first < second)) {
    return {.rule = "the range is empty", .remedy = "the first bound must be less than the second; --vary takes single values"};
  }
  if (!std::isfinite(second - first))
    return {.rule = "the range is too wide", .remedy = "give bounds that differ by less than 1e308"};
  if (name == "log_uniform" && !(first > 0.0)) {
    return {.rule = "both bounds must be greater than 0", .remedy = "use uniform(a,b) for a range that has 0"};
  }
  if (name != "integer") return {};
  const bool whole = first == std::floor(first) && second == std::floor(second);
  if (!whole || std::max(std::abs(first), std::abs(second)) > kLargestInteger) {
    return {.rule = "both bounds must be integers of at most 2^53", .remedy = "round them, or use uniform(a,b)"};
  }
  return {};
}

std::string sample_of(const Distribution& distribution, std::uint64_t seed, std::uint64_t number) {
  const auto& [name, first, second] = distribution;
  const double share = random_number(seed, 2 * number);
  if (name == "uniform") return format_number(std::min(first + (second - first) * share, second));
  if (name == "log_uniform")
    return format_number(std::clamp(first * std::exp((std::log(second) - std::log(first)) * share), first, second));
  if (name == "integer") return format_number(std::min(first + std::floor((second - first + 1.0) * share), second));
  // Box and Muller 1958; 1 - share is never 0.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - share));
  const double angle = 2.0 * std::numbers::pi * random_number(seed, 2 * number + 1);
  return format_number(first + second * radius * std::cos(angle));
}

std::pair<std::string, std::string> key_and_text(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {text, ""};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

std::vector<std::string> split_values(std::string_view text) {
  std::vector<std::string> values(1);
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (in_string && letter == '\\' && i + 1 < text.size()) {
      values.back() += letter;
      values.back() += text[++i];
      continue;
    }
    if (letter == '"') in_string = !in_string;
    if (!in_string && (letter == '[' || letter == '{')) ++depth;
    if (!in_string && (letter == ']' || letter == '}')) --depth;
    if (letter == ',' && !in_string && depth <= 0) {
      values.emplace_back();
    } else {
      values.back() += letter;
    }
  }
  return values;
}

SweepPlan::SweepPlan(const SweepRequest& request) {
  std::vector<Problem> problems;
  if (request.vary.empty() && request.sample.empty()) {
    problems.push_back({.key = "--vary", .rule = "nothing varies", .remedy = "give --vary KEY=V1,V2,... or --sample with --count"});
  }
  if (!request.sample.empty() && request.count < 1) {
    problems.push_back({.key = "--count", .rule = "--sample needs the number of samples", .remedy = "give --count N"});
  }
  if (request.sample.empty() && request.count > 0) {
    problems.push_back({.key = "--count", .rule = "nothing is sampled", .remedy = "give --sample KEY=uniform(a,b) too"});
  }
  for (const std::string& text : request.vary) read_grid(text, problems);
  grids_ = keys_.size();
  for (const std::string& text : request.sample) read_samples(text, request, problems);
  if (!request.sample.empty()) samples_ = std::max(request.count, 1);
  double runs = samples_;
  for (std::size_t key = 0; key < grids_; ++key) runs *= static_cast<double>(values_[key].size());
  if (runs > kMostRuns) {
    problems.push_back({.key = "--vary",
                        .value = format_number(runs, 6) + " runs",
                        .rule = "a sweep has at most " + std::to_string(kMostRuns),
                        .remedy = "give fewer values, or several sweeps"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  runs_ = static_cast<int>(runs);
}

void SweepPlan::add_key(const char* option, const std::string& key, std::vector<Problem>& problems) {
  if (std::ranges::find(keys_, key) != keys_.end()) {
    problems.push_back({.key = option, .value = key, .rule = "the key is given twice", .remedy = "join its values in one option"});
  }
  keys_.push_back(key);
  values_.emplace_back();
}

void SweepPlan::read_grid(const std::string& text, std::vector<Problem>& problems) {
  const auto [key, list] = key_and_text(text);
  if (key.empty() || list.empty()) {
    const std::string rule = key.empty() || text == key ? "is not of the form KEY=V1,V2,..." : "the range is empty";
    problems.push_back({.key = "--vary", .value = text, .rule = rule, .remedy = "give at least one value: KEY=V1,V2,..."});
    return;
  }
  add_key("--vary", key, problems);
  for (const std::string& value : split_values(list)) {
    std::vector<std::string>& values = values_.back();
    if (value.empty()) {
      problems.push_back({.key = "--vary", .value = text, .rule = "a value is empty", .remedy = "remove the extra comma"});
    } else if (std::ranges::find(values, value) != values.end()) {
      problems.push_back({.key = "--vary", .value = text, .rule = value + " is given twice", .remedy = "give each value once"});
    } else {
      values.push_back(value);
    }
  }
}

void SweepPlan::read_samples(const std::string& text, const SweepRequest& request, std::vector<Problem>& problems) {
  const auto [key, form] = key_and_text(text);
  const auto distribution = read_distribution(form);
  if (key.empty() || !distribution) {
    problems.push_back({.key = "--sample", .value = text, .rule = "is no distribution of a key", .remedy = kForms});
    return;
  }
  add_key("--sample", key, problems);
  if (Problem problem = check(*distribution); !problem.rule.empty()) {
    problem.key = "--sample";
    problem.value = text;
    problems.push_back(std::move(problem));
    return;
  }
  const std::uint64_t seed = mixed_bits(request.seed) ^ fingerprint_of(key);
  for (int k = 0; k < std::min(request.count, kMostRuns); ++k) {
    values_.back().push_back(sample_of(*distribution, seed, static_cast<std::uint64_t>(k)));
  }
}

std::vector<std::string> SweepPlan::values_of(int run) const {
  std::vector<std::string> values(keys_.size());
  const auto index = static_cast<std::size_t>(run - 1);
  const std::size_t sample = index % static_cast<std::size_t>(samples_);
  std::size_t point = index / static_cast<std::size_t>(samples_);
  for (std::size_t key = keys_.size(); key-- > 0;) {
    if (key >= grids_) {
      values[key] = values_[key][sample];
    } else {
      values[key] = values_[key][point % values_[key].size()];
      point /= values_[key].size();
    }
  }
  return values;
}

std::vector<std::string> overrides_of(const SweepPlan& plan, int run) {
  std::vector<std::string> overrides = plan.values_of(run);
  for (std::size_t key = 0; key < overrides.size(); ++key) overrides[key] = plan.keys()[key] + "=" + overrides[key];
  return overrides;
}

std::string run_name(int run) {
  constexpr std::size_t kDigits = 4;
  const std::string digits = std::to_string(run);
  return std::string(digits.size() < kDigits ? kDigits - digits.size() : 0, '0') + digits;
}

}  // namespace sprung
