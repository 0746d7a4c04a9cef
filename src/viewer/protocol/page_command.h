// A message of a page, read with care: a page may send anything.
#pragma once

#include "base/types.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace sprung {

/// A message that was not understood.
class PageCommandError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A JSON object with a key `do`. All members but name() throw PageCommandError if the key is missing or has another type.
class PageCommand {
 public:
  /// Throws PageCommandError if the text is not such an object, or is nested deeply.
  explicit PageCommand(const std::string& text);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool has(const char* key) const { return message_.contains(key); }
  [[nodiscard]] std::string text(const char* key) const;
  /// False without the key.
  [[nodiscard]] bool flag(const char* key) const;
  [[nodiscard]] double number(const char* key) const;
  /// Throws PageCommandError if the number is not a whole number, or outside of the bounds.
  [[nodiscard]] std::int64_t integer(const char* key, std::int64_t low, std::int64_t high) const;
  [[nodiscard]] Vector3 vector(const char* key) const;
  /// Any value, as JSON text.
  [[nodiscard]] std::string json(const char* key) const;

 private:
  [[nodiscard]] const nlohmann::ordered_json& at(const char* key) const;

  nlohmann::ordered_json message_;
  std::string name_;
};

}  // namespace sprung
