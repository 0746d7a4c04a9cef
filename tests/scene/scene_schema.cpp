// GCC 12 falsely reports overlapping copies in the "[" + name + "]" of valijson's templates (its bug 105651).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include "scene/scene_schema.h"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <cmath>
#include <fstream>
#include <memory>

namespace sprung {
namespace {

using PlainJson = nlohmann::json;  // valijson has no adapter for the ordered type

const valijson::Schema& parsed_schema() {
  static const auto kSchema = [] {
    const PlainJson text = PlainJson::parse(json_text(scene_schema()));
    auto parsed = std::make_unique<valijson::Schema>();
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(valijson::adapters::NlohmannJsonAdapter(text), *parsed);
    return parsed;
  }();
  return *kSchema;
}

/// Converts 64.0 to 64: JSON has one type of number, but valijson distinguishes by the notation.
void make_whole_numbers_integers(PlainJson& json) {
  constexpr double kLargestExact = 9007199254740992.0;  // 2^53
  if (json.is_structured()) {
    for (PlainJson& entry : json) make_whole_numbers_integers(entry);
  } else if (json.is_number_float()) {
    const double value = json.get<double>();
    if (std::floor(value) == value && std::abs(value) < kLargestExact) json = static_cast<std::int64_t>(value);
  }
}

}  // namespace

const Json& scene_schema() {
  static const Json kSchema = Json::parse(std::ifstream(std::string(SPRUNG_SOURCE_DIR) + "/src/scene/scene.schema.json"));
  return kSchema;
}

std::vector<std::string> schema_violations(const Json& document) {
  PlainJson plain = PlainJson::parse(json_text(document));
  make_whole_numbers_integers(plain);
  valijson::ValidationResults results;
  valijson::Validator().validate(parsed_schema(), valijson::adapters::NlohmannJsonAdapter(plain), &results);
  std::vector<std::string> violations;
  for (const auto& error : results) {
    std::string path;
    for (const std::string& level : error.context) path += level;
    violations.push_back(path + ": " + error.description);
  }
  return violations;
}

}  // namespace sprung
