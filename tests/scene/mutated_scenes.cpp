#include "scene/mutated_scenes.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>

namespace sprung {
namespace {

using Pointer = Json::json_pointer;
using Pick = std::function<std::size_t(std::size_t)>;

/// Pointers to all values below the document.
void list_values(const Json& json, const Pointer& at, std::vector<Pointer>& pointers) {
  if (!at.empty()) pointers.push_back(at);
  if (json.is_object()) {
    for (const auto& item : json.items()) list_values(item.value(), at / item.key(), pointers);
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) list_values(json[i], at / i, pointers);
  }
}

/// Changes the value at `at`; false if the mutation does not apply.
using Mutation = std::function<bool(Json& document, const Pointer& at, const Pick& pick)>;

bool remove(Json& document, const Pointer& at, const Pick& /*pick*/) {
  Json& parent = document[at.parent_pointer()];
  if (parent.is_object()) {
    parent.erase(at.back());
  } else {
    parent.erase(std::stoul(at.back()));
  }
  return true;
}

bool change_type(Json& document, const Pointer& at, const Pick& pick) {
  const std::array<Json, 7> values{true, 3, 0.5, "text", Json::array({1, "a"}), Json::object(), Json::object({{"a", 1}})};
  document[at] = values.at(pick(values.size()));
  return true;
}

bool set_null(Json& document, const Pointer& at, const Pick& /*pick*/) {
  document[at] = nullptr;
  return true;
}

bool change_number(Json& document, const Pointer& at, const std::vector<Json>& values, const Pick& pick) {
  if (!document[at].is_number()) return false;
  document[at] = values.at(pick(values.size()));
  return true;
}

bool negate(Json& document, const Pointer& at, const Pick& /*pick*/) {
  if (!document[at].is_number()) return false;
  document[at] = -document[at].get<double>();
  return true;
}

bool enlarge(Json& document, const Pointer& at, const Pick& pick) {
  return change_number(document, at, {1e30, 1.1e30, -1.1e30, 1e300, 4294967298, 2147483648, 1e18}, pick);
}

/// Values on both sides of the bounds of scenes.
bool set_to_bound(Json& document, const Pointer& at, const Pick& pick) {
  const std::vector<Json> values{0,      0.0,    -0.0,      1,         1.0,       1.0000001, 2,      2.5,
                                 -1e-30, 1e-300, 134217727, 134217728, 134217729, 1000000,   1000001};
  return change_number(document, at, values, pick);
}

bool misspell(Json& document, const Pointer& at, const Pick& pick) {
  if (!document[at].is_string()) return false;
  std::string word = document[at].get<std::string>();
  const std::size_t position = pick(word.size() + 1);
  switch (pick(4)) {
    case 0:
      word.insert(position, 1, 'q');
      break;
    case 1:
      word.erase(std::min(position, word.size()));
      break;
    case 2:
      word.insert(position, 1, '*');
      break;
    default:
      word.clear();
  }
  document[at] = word;
  return true;
}

bool empty_array(Json& document, const Pointer& at, const Pick& /*pick*/) {
  if (!document[at].is_array()) return false;
  document[at] = Json::array();
  return true;
}

bool repeat_entry(Json& document, const Pointer& at, const Pick& pick) {
  Json& array = document[at];
  if (!array.is_array() || array.empty()) return false;
  array.push_back(Json(array[pick(array.size())]));
  return true;
}

bool add_unknown_key(Json& document, const Pointer& at, const Pick& pick) {
  const std::array<const char*, 4> keys{"colour", "stifness", "", "Duration"};
  if (!document[at].is_object()) return false;
  document[at][keys.at(pick(keys.size()))] = 1;
  return true;
}

bool rename(Json& document, const Pointer& at, const Pick& pick) {
  const std::array<std::string, 8> names{"obstacles",          "a b", "rope2", "2rope", "", "a/b", std::string(200, 'x'),
                                         std::string(201, 'x')};
  Json& parent = document[at.parent_pointer()];
  if (!parent.is_object()) return false;
  Json value = std::move(parent[at.back()]);
  parent.erase(at.back());
  parent[names.at(pick(names.size()))] = std::move(value);
  return true;
}

/// Adds a key that excludes an existing one.
bool add_excluded_key(Json& document, const Pointer& at, const Pick& pick) {
  static const std::vector<std::vector<Json>> kGroups{
      {{{"mass", 1}}, {{"particle_mass", 1}}, {{"density", 1}}},
      {{{"stiffness", 1}}, {{"modulus", 1}}},
      {{{"damping", 0.1}}, {{"damping_ratio", 0.1}}, {{"damping_rate", 0.1}}},
      {{{"from", {0, 0, 0}}}, {{"points", {{0, 0, 0}, {1, 0, 0}}}}},
      {{{"at", "corner"}}, {{"indices", {0}}}, {{"nearest", {0, 0, 0}}}, {{"box", {{0, 0, 0}, {1, 1, 1}}}}},
  };
  Json& object = document[at];
  if (!object.is_object()) return false;
  for (const auto& group : kGroups) {
    const auto exists = [&](const Json& key) { return object.contains(key.items().begin().key()); };
    if (std::none_of(group.begin(), group.end(), exists)) continue;
    object.update(group[pick(group.size())]);
    return true;
  }
  return false;
}

const std::vector<std::pair<std::string, Mutation>>& mutations() {
  static const std::vector<std::pair<std::string, Mutation>> kMutations{
      {"remove", remove},
      {"change the type", change_type},
      {"set to null", set_null},
      {"negate", negate},
      {"enlarge", enlarge},
      {"set to a bound", set_to_bound},
      {"misspell", misspell},
      {"empty the array", empty_array},
      {"repeat an entry", repeat_entry},
      {"add an unknown key", add_unknown_key},
      {"rename", rename},
      {"add an excluded key", add_excluded_key},
  };
  return kMutations;
}

constexpr const char* kForeignKey = "add a key of another object";
constexpr const char* kForeignValue = "take the value of the same key elsewhere";

}  // namespace

SceneMutator::SceneMutator(std::vector<Json> valid, std::uint32_t seed) : valid_(std::move(valid)), random_(seed) {
  for (const Json& document : valid_) collect(document);
}

std::vector<std::string> SceneMutator::mutation_names() {
  std::vector<std::string> names{kForeignKey, kForeignValue};
  for (const auto& mutation : mutations()) names.push_back(mutation.first);
  return names;
}

void SceneMutator::collect(const Json& json) {
  for (const auto& item : json.items()) {
    if (json.is_object()) entries_.push_back({item.key(), item.value()});
    if (item.value().is_structured()) collect(item.value());
  }
}

MutatedScene SceneMutator::next() {
  constexpr int kPositionsToTry = 50;  // few values are arrays or strings
  MutatedScene scene{valid_[pick(valid_.size())], {}};
  const std::size_t number = pick(5) > 0 ? 1 : 2 + pick(2);
  while (scene.changes.size() < number) {
    const std::size_t kind = pick(mutations().size() + 2);
    std::string change;
    for (int i = 0; i < kPositionsToTry && change.empty(); ++i) change = mutate(scene.document, kind);
    if (!change.empty()) scene.changes.push_back(change);
  }
  return scene;
}

std::string SceneMutator::mutate(Json& document, std::size_t kind) {
  std::vector<Pointer> pointers;
  list_values(document, Pointer(), pointers);
  if (pointers.empty()) return "nothing is left";
  const Pointer at = pointers[pick(pointers.size())];
  if (kind < mutations().size()) {
    const auto& [name, mutation] = mutations()[kind];
    return mutation(document, at, [this](std::size_t count) { return pick(count); }) ? name + " at " + at.to_string() : "";
  }
  if (kind == mutations().size()) {
    if (!document[at].is_object()) return "";
    const Entry& entry = entries_[pick(entries_.size())];
    document[at][entry.key] = entry.value;
    return kForeignKey + std::string(", ") + entry.key + ", at " + at.to_string();
  }
  std::vector<const Entry*> same;
  for (const Entry& other : entries_) {
    if (other.key == at.back()) same.push_back(&other);
  }
  if (same.empty()) return "";
  document[at] = same[pick(same.size())]->value;
  return kForeignValue + std::string(" at ") + at.to_string();
}

}  // namespace sprung
