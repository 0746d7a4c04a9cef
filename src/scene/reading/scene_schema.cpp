// GCC 12 sees overlapping copies in the "[" + name + "]" of valijson's templates (its bug 105651).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include "scene/reading/scene_schema.h"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace sprung {
namespace {

using PlainJson = nlohmann::json;  // valijson has no adapter for the ordered kind
using Violations = std::vector<SchemaViolation>;

constexpr std::size_t kMostViolations = 1000;  // enough for any person to read; they are compared with each other

const valijson::Schema& parsed_schema() {
  static const auto kSchema = [] {
    const PlainJson text = PlainJson::parse(scene_schema());
    auto parsed = std::make_unique<valijson::Schema>();
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(valijson::adapters::NlohmannJsonAdapter(text), *parsed);
    return parsed;
  }();
  return *kSchema;
}

/// JSON has one kind of number, where 64.0 is a whole one; valijson goes by how it was written.
void make_whole_numbers_integers(PlainJson& json) {
  constexpr double kLargestExact = 9007199254740992.0;  // 2^53
  if (json.is_structured()) {
    for (PlainJson& entry : json) make_whole_numbers_integers(entry);
  } else if (json.is_number_float()) {
    const double value = json.get<double>();
    if (std::floor(value) == value && std::abs(value) < kLargestExact) json = static_cast<std::int64_t>(value);
  }
}

/// valijson's context is `<root>`, then `[key]` or `[3]` a level.
std::string path_of(const std::vector<std::string>& context, const PlainJson& document) {
  std::string path;
  const PlainJson* at = &document;
  for (std::size_t level = 1; level < context.size(); ++level) {
    const std::string name = context[level].substr(1, context[level].size() - 2);
    path = at->is_array() ? path + context[level] : join_path(path, name);
    at = at->is_array() ? &at->at(std::stoul(name)) : &at->at(name);
  }
  return path;
}

bool is_below(const std::string& path, const std::string& ancestor) {
  if (path.size() <= ancestor.size() || !path.starts_with(ancestor)) return false;
  return ancestor.empty() || path[ancestor.size()] == '.' || path[ancestor.size()] == '[';
}

/// What lies below a failed oneOf tells of all its branches, also of those that were not meant: the oneOf alone counts. What lies
/// above another violation only repeats it.
Violations innermost(const Violations& all) {
  const auto is_choice = [](const SchemaViolation& violation) { return violation.rule.find("oneOf") != std::string::npos; };
  Violations outside_choices;
  for (const SchemaViolation& violation : all) {
    const bool within = std::any_of(all.begin(), all.end(), [&](const SchemaViolation& other) {
      return is_choice(other) && (is_below(violation.path, other.path) || (violation.path == other.path && !is_choice(violation)));
    });
    if (!within) outside_choices.push_back(violation);
  }
  Violations result;
  for (const SchemaViolation& violation : outside_choices) {
    const auto repeats = [&](const SchemaViolation& other) { return is_below(other.path, violation.path); };
    const auto same = [&](const SchemaViolation& other) { return other.path == violation.path; };
    if (std::any_of(outside_choices.begin(), outside_choices.end(), repeats)) continue;
    if (std::none_of(result.begin(), result.end(), same)) result.push_back(violation);
  }
  return result;
}

}  // namespace

std::vector<SchemaViolation> schema_violations(const Json& document) {
  PlainJson plain = PlainJson::parse(json_text(document));
  make_whole_numbers_integers(plain);
  valijson::ValidationResults results;
  valijson::Validator().validate(parsed_schema(), valijson::adapters::NlohmannJsonAdapter(plain), &results);
  Violations violations;
  for (const auto& error : results) {
    if (violations.size() == kMostViolations) break;
    violations.push_back({path_of(error.context, plain), error.description});
  }
  return innermost(violations);
}

}  // namespace sprung
