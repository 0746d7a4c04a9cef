#include "scene/json/json_fields.h"

#include "scene/json/nearest_name.h"

#include <algorithm>

namespace sprung {

bool check_object(const Json& json, const JsonLocation& location) {
  if (json.is_object()) return true;
  location.report(json, "must be an object, written in { }");
  return false;
}

std::optional<std::string> Fields::one_of(const std::vector<std::string>& keys, bool or_nothing) {
  std::vector<std::string> written;
  for (const std::string& key : keys) {
    if (has(key)) written.push_back(key);
  }
  if (written.size() == 1) return written.front();
  if (written.empty() && !or_nothing) location_.report_key("must have one of " + joined(keys), "add one of them");
  if (written.size() > 1) {
    location_.report_key("may have only one of " + joined(keys), "it has " + joined(written) + ": remove all but one");
  }
  return std::nullopt;
}

std::optional<std::size_t> Fields::kind(const std::string& key, const std::vector<std::string>& kinds,
                                        const WordRemedies& remedies) {
  const auto kind = required(key, word_of(kinds, remedies));
  kind_is_known_ = kind.has_value();
  return kind;
}

std::optional<std::size_t> Fields::kind(const std::string& key, const std::vector<std::string>& kinds,
                                        const std::string& fallback) {
  if (!has(key)) json_[key] = fallback;
  return kind(key, kinds);
}

void Fields::accept_keys_of_all_kinds(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) accept(key);
  kind_is_known_ = true;
}

void Fields::accept(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
}

void Fields::set_remedy(const std::vector<std::string>& keys, const std::string& remedy) {
  for (const std::string& key : keys) remedies_[key] = remedy;
}

void Fields::set_owner(const std::vector<std::string>& keys, const std::string& owner) {
  for (const std::string& key : keys) {
    set_remedy({key}, "it belongs to " + owner + ": write \"" + owner + "\": { \"" + key + "\": ... }");
  }
}

bool Fields::has(const std::string& key) {
  accept(key);
  return json_.contains(key);
}

void Fields::report_missing(const std::string& key) const { location_.at(key).report_key("is missing", "it is required: add it"); }

void Fields::reject_unknown_keys() const {
  if (!kind_is_known_) return;
  for (const auto& [key, value] : json_.items()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const auto remedy_of_key = remedies_.find(key);
    location_.at(key).report_key("is not a known key",
                                 remedy_of_key != remedies_.end() ? remedy_of_key->second : suggestion(key, known_));
    if (location_.unknown_keys != nullptr) ++*location_.unknown_keys;
  }
}

}  // namespace sprung
