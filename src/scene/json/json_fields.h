// Reads the keys of JSON objects: known keys, required keys and defaults. Defaults are written into the document, so that it is
// complete afterwards.
#pragma once

#include "scene/json/json_rules.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// Whether the value is an object; otherwise reports a problem.
[[nodiscard]] bool check_object(const Json& json, const JsonLocation& location);

/// The keys of one object. A key is known once it was requested; `reject_unknown_keys` reports the others.
class Fields {
 public:
  Fields(Json& json, JsonLocation location) : json_(json), location_(std::move(location)) {}

  /// The value; none if it is missing (which is reported) or invalid.
  template <class T>
  std::optional<T> required(const std::string& key, const Rule<T>& rule) {
    if (!has(key)) report_missing(key);
    return optional(key, rule);
  }

  /// The value, or `fallback` if it is missing; none if it is invalid.
  template <class T>
  std::optional<T> value(const std::string& key, const Rule<T>& rule, const Json& fallback) {
    if (!has(key)) json_[key] = fallback;
    return optional(key, rule);
  }

  /// The value; none if it is missing or invalid.
  template <class T>
  std::optional<T> optional(const std::string& key, const Rule<T>& rule) {
    if (!has(key)) return std::nullopt;
    return rule(json_[key], location_.at(key));
  }

  /// The one of the keys that is present. Reports none or several and then returns none. `or_nothing`: all may be missing.
  std::optional<std::string> one_of(const std::vector<std::string>& keys, bool or_nothing = false);

  /// The required key that selects the kind of object, as an index into `kinds`. If it is invalid, no key counts as unknown.
  std::optional<std::size_t> kind(const std::string& key, const std::vector<std::string>& kinds, const WordRemedies& remedies = {});
  /// Likewise, for an optional key.
  std::optional<std::size_t> kind(const std::string& key, const std::vector<std::string>& kinds, const std::string& fallback);

  /// Accepts the keys of all kinds without reading them, for an invalid kind. All other keys then count as unknown.
  void accept_keys_of_all_kinds(const std::vector<std::string>& keys);

  /// Makes a key known without reading it.
  void accept(const std::string& key);

  /// The remedy for keys that are unknown here but known elsewhere.
  void set_remedy(const std::vector<std::string>& keys, const std::string& remedy);

  /// The remedy for keys that belong to the object under `owner`.
  void set_owner(const std::vector<std::string>& keys, const std::string& owner);

  [[nodiscard]] bool has(const std::string& key);
  [[nodiscard]] const Json& json() const { return json_; }
  [[nodiscard]] Json& json() { return json_; }
  [[nodiscard]] const JsonLocation& location() const { return location_; }
  void reject_unknown_keys() const;

 private:
  void report_missing(const std::string& key) const;

  Json& json_;
  JsonLocation location_;
  std::vector<std::string> known_;
  std::map<std::string, std::string> remedies_;  ///< by key
  bool kind_is_known_ = true;
};

/// An object whose keys are read by `read`; none if `read` returns none.
template <class T, class Read>
[[nodiscard]] Rule<T> object_of(Read read) {
  return [=](Json& json, const JsonLocation& location) -> std::optional<T> {
    if (!check_object(json, location)) return std::nullopt;
    Fields fields(json, location);
    std::optional<T> value = read(fields);
    fields.reject_unknown_keys();
    return value;
  };
}

}  // namespace sprung
