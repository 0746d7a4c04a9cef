#include "viewer/protocol/page_command.h"

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

// Values are copied and written by functions that call themselves once a level.
constexpr int kMostLevels = 64;

[[noreturn]] void refuse(const std::string& reason) { throw PageCommandError("the message was not understood: " + reason); }

Json parsed(const std::string& text) try {
  return Json::parse(text, [](int level, Json::parse_event_t, Json&) {
    if (level > kMostLevels) refuse("it is nested too deeply");
    return true;
  });
} catch (const Json::exception& error) {
  refuse(error.what());
}

}  // namespace

PageCommand::PageCommand(const std::string& text) : message_(parsed(text)) {
  if (!message_.is_object()) refuse("it is not an object");
  name_ = this->text("do");
}

const Json& PageCommand::at(const char* key) const {
  const auto found = message_.find(key);
  if (found == message_.end()) refuse(std::string("it has no key ") + key);
  return *found;
}

std::string PageCommand::text(const char* key) const {
  const Json& value = at(key);
  if (!value.is_string()) refuse(std::string(key) + " must be a text");
  return value.get<std::string>();
}

bool PageCommand::flag(const char* key) const {
  if (!has(key)) return false;
  const Json& value = at(key);
  if (!value.is_boolean()) refuse(std::string(key) + " must be true or false");
  return value.get<bool>();
}

double PageCommand::number(const char* key) const {
  const Json& value = at(key);
  if (!value.is_number()) refuse(std::string(key) + " must be a number");
  return value.get<double>();
}

std::int64_t PageCommand::integer(const char* key, std::int64_t low, std::int64_t high) const {
  const Json& value = at(key);
  // The bounds are checked as a double first: a conversion of a larger one is undefined.
  const bool inside = value.is_number_integer() && value.get<double>() >= static_cast<double>(low) &&
                      value.get<double>() <= static_cast<double>(high);
  if (!inside) refuse(std::string(key) + " must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return value.get<std::int64_t>();
}

Vector3 PageCommand::vector(const char* key) const {
  const Json& value = at(key);
  const bool three = value.is_array() && value.size() == 3;
  if (!three || !value[0].is_number() || !value[1].is_number() || !value[2].is_number()) {
    refuse(std::string(key) + " must be three numbers");
  }
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

std::string PageCommand::json(const char* key) const { return at(key).dump(); }

}  // namespace sprung
