// The keys of JSON objects: which there are, which must be, and their defaults. Defaults are written into the document, so that it
// ends up complete.
#pragma once

#include "scene/json/json_rules.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// Whether it is an object; reports when it is not.
[[nodiscard]] bool check_object(const Json& json, const JsonPlace& place);

/// The keys of one object. A key is known once it was asked for; `reject_unknown_keys` reports the others.
class Fields {
 public:
  Fields(Json& json, JsonPlace place) : json_(json), place_(std::move(place)) {}

  /// The value, or none when it is missing (which is reported) or broken.
  template <class T>
  std::optional<T> required(const std::string& key, const Rule<T>& rule) {
    if (!has(key)) report_missing(key);
    return optional(key, rule);
  }

  /// The value, `fallback` when it is missing, or none when it is broken.
  template <class T>
  std::optional<T> value(const std::string& key, const Rule<T>& rule, const Json& fallback) {
    if (!has(key)) json_[key] = fallback;
    return optional(key, rule);
  }

  /// The value, or none when it is missing or broken.
  template <class T>
  std::optional<T> optional(const std::string& key, const Rule<T>& rule) {
    if (!has(key)) return std::nullopt;
    return rule(json_[key], place_.at(key));
  }

  /// Which of the keys is written: reports none or several, and then returns none. `or_nothing`: none may be written.
  std::optional<std::string> one_of(const std::vector<std::string>& keys, bool or_nothing = false);

  /// The required key that says what kind of object it is, as a number in the list. When it is broken no key counts as unknown.
  std::optional<std::size_t> kind(const std::string& key, const std::vector<std::string>& kinds);
  /// The same for a key that may be missing.
  std::optional<std::size_t> kind(const std::string& key, const std::vector<std::string>& kinds, const std::string& fallback);

  /// Makes these keys known without reading them, and all others unknown though the kind is broken: no kind has any of those.
  void knows_no_others(const std::vector<std::string>& keys);

  /// Makes a key known without reading it.
  void accept(const std::string& key);

  /// What to do about keys that are not known here, but are elsewhere.
  void belongs_elsewhere(const std::vector<std::string>& keys, const std::string& remedy);

  [[nodiscard]] bool has(const std::string& key);
  [[nodiscard]] const Json& json() const { return json_; }
  [[nodiscard]] const JsonPlace& place() const { return place_; }
  void reject_unknown_keys() const;

 private:
  void report_missing(const std::string& key) const;

  Json& json_;
  JsonPlace place_;
  std::vector<std::string> known_;
  std::map<std::string, std::string> elsewhere_;  ///< remedies by key
  bool kind_is_known_ = true;
};

/// An object whose keys `read` asks for; none when it returns none.
template <class T, class Read>
[[nodiscard]] Rule<T> object_of(Read read) {
  return [=](Json& json, const JsonPlace& place) -> std::optional<T> {
    if (!check_object(json, place)) return std::nullopt;
    Fields fields(json, place);
    std::optional<T> value = read(fields);
    fields.reject_unknown_keys();
    return value;
  };
}

}  // namespace sprung
