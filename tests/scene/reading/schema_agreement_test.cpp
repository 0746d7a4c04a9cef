// The published schema and the rules have the same keys, and accept and refuse the same scenes.
#include "base/test_seed.h"
#include "scene/broken_scenes.h"
#include "scene/json/overrides.h"
#include "scene/mutated_scenes.h"
#include "scene/scene_schema.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

namespace sprung {
namespace {

using testing::IsEmpty;
using testing::IsSubsetOf;

using Keys = std::set<std::string>;

/// The node to which a reference points.
Json resolved(const Json& node) {
  if (!node.contains("$ref")) return node;
  const std::string name = node["$ref"].get<std::string>();
  return scene_schema()["definitions"][name.substr(name.rfind('/') + 1)];
}

bool matches_branch(const Json& branch, const Json& instance) {
  for (const auto& key : branch.value("required", Json::array())) {
    if (!instance.contains(key.get<std::string>())) return false;
  }
  for (const auto& property : branch["properties"].items()) {
    if (!property.value().contains("const")) continue;
    if (instance.contains(property.key()) && instance[property.key()] != property.value()["const"]) return false;
  }
  return true;
}

Keys keys_of(const Json& object) {
  Keys keys;
  for (const auto& property : object["properties"].items()) keys.insert(property.key());
  return keys;
}

/// An object of a scene: its location, the keys that the schema allows in it, and those that it allows in any branch of its oneOf.
struct ObjectKeys {
  std::string pointer;
  Keys allowed;
  Keys allowed_in_any_branch;
};

void collect(const Json& instance, const Json& unresolved, const std::string& pointer, std::vector<ObjectKeys>& objects) {
  const Json node = resolved(unresolved);
  if (instance.is_array()) {
    for (std::size_t i = 0; i < instance.size(); ++i) {
      const Json items = node.is_object() ? node.value("items", Json::object()) : Json::object();
      collect(instance[i], items.is_array() ? items[i] : items, pointer + "/" + std::to_string(i), objects);
    }
    return;
  }
  if (!instance.is_object()) return;
  Json object = node;
  Keys any;
  if (!node.contains("properties") && node.contains("oneOf")) {
    for (const Json& unresolved_branch : node["oneOf"]) {
      const Json branch = resolved(unresolved_branch);
      if (!branch.contains("properties")) continue;
      any.merge(keys_of(branch));
      if (matches_branch(branch, instance)) object = branch;
    }
  }
  if (object.contains("properties")) {
    any.merge(keys_of(object));
    objects.push_back({pointer, keys_of(object), any});
  }
  for (const auto& entry : instance.items()) {
    const bool by_name = !object.contains("properties");
    const Json& below = by_name ? object["additionalProperties"] : object["properties"][entry.key()];
    collect(entry.value(), below, pointer + "/" + entry.key(), objects);
  }
}

/// The keys that the rules suggest for an unknown key.
Keys keys_known_to_rules(const SceneFolder& folder, Json scene, const std::string& pointer) {
  scene[Json::json_pointer(pointer)]["qqqqqqqqqqqqqqqq"] = 1;
  const auto problems = problems_of([&] { (void)folder.read(json_text(scene)); });
  if (problems.size() != 1) return {};
  const std::string offered = "choose from ";
  EXPECT_EQ(problems[0].remedy.substr(0, offered.size()), offered);
  std::istringstream list(problems[0].remedy.substr(offered.size()));
  Keys keys;
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.insert(key);
  return keys;
}

TEST(SchemaAgreement, AcceptsTheScenesThatTheRulesAccept) {
  const SceneFolder folder;
  for (const char* text : {kPlainScene, kFullScene}) {
    EXPECT_THAT(schema_violations(parse_json(text, "").document), IsEmpty());
    EXPECT_THAT(schema_violations(parse_json(folder.read(text).resolved, "").document), IsEmpty()) << "with defaults filled in";
  }
}

TEST(SchemaAgreement, HasExactlyTheKeysOfTheRules) {
  const SceneFolder folder;
  const Json scene = parse_json(folder.read(kFullScene).resolved, "").document;
  std::vector<ObjectKeys> objects;
  collect(scene, scene_schema(), "", objects);
  EXPECT_GT(objects.size(), 50U);
  for (const ObjectKeys& object : objects) {
    const Keys known = keys_known_to_rules(folder, scene, object.pointer);
    EXPECT_THAT(object.allowed, IsSubsetOf(known)) << object.pointer;
    EXPECT_THAT(known, IsSubsetOf(object.allowed_in_any_branch)) << object.pointer;
  }
}

TEST(SchemaAgreement, EveryDefinitionAndKeyIsDescribed) {
  std::vector<const Json*> open{&scene_schema()};
  while (!open.empty()) {
    const Json& node = *open.back();
    open.pop_back();
    if (!node.is_structured()) continue;
    // Conditions repeat keys that are described where they are defined.
    if (node.is_object() && node.contains("if")) continue;
    for (const Json& entry : node) open.push_back(&entry);
    if (!node.is_object() || !node.contains("properties")) continue;
    for (const auto& property : node["properties"].items()) {
      EXPECT_TRUE(property.value().contains("$ref") || property.value().contains("description")) << property.key();
    }
  }
}

/// Rules that a schema cannot express, because they involve several values. Each category lists the beginnings of its rules.
const std::map<std::string, std::vector<std::string>>& rules_beyond_the_schema() {
  static const std::map<std::string, std::vector<std::string>> kRules{
      {"times that must fit together", {"makes more than"}},
      {"the product of values", {"must make at most"}},
      {"the order of values",
       {"must be later than the keyframe before it", "must be later than from", "must begin with the smaller coordinates"}},
      {"a value that another one bounds", {"must be at least friction", "needs springs with stiffness"}},
      {"a value that another object forbids",
       {"needs contact.response", "needs a rope, a cloth or a solid", "needs a mesh", "needs cells", "needs a closed mesh",
        "needs a rope, a cloth or a mesh", "needs the model spring", "is set by damping_ratio of the kind",
        "is not for the angles of a mesh"}},
      {"a name of another object", {"must be the name of a body", "must be the name of an obstacle"}},
      {"a vector without a direction", {"must not be zero"}},
      {"one body at both ends", {"must select particles"}},
  };
  return kRules;
}

/// Whether the problem is a corner of another shape: the schema does not compare a pin with its body.
bool is_corner_of_another_shape(const Problem& problem) {
  if (problem.key.find(".which[") == std::string::npos) return false;
  const Json corners = scene_schema()["definitions"]["corners"]["items"]["enum"];
  return std::any_of(corners.begin(), corners.end(), [&](const Json& corner) { return corner.dump() == problem.value; });
}

bool is_beyond_the_schema(const Problem& problem) {
  if (is_corner_of_another_shape(problem)) return true;
  for (const auto& category : rules_beyond_the_schema()) {
    for (const std::string& rule : category.second) {
      if (problem.rule.starts_with(rule)) return true;
    }
  }
  return false;
}

struct Verdict {
  bool accepted_by_schema = false;
  std::string disagreement;  ///< empty if schema and rules agree
};

Verdict judge(const SceneFolder& folder, const Json& document) {
  const auto problems = problems_of([&] { (void)folder.read(json_text(document)); });
  const auto violations = schema_violations(document);
  if (!violations.empty()) return {false, problems.empty() ? "only the schema refuses it: " + violations.front() : ""};
  const auto known = std::find_if_not(problems.begin(), problems.end(), is_beyond_the_schema);
  return {true, known == problems.end() ? "" : "only the rules refuse it: " + to_string(*known)};
}

/// The scenes of this source tree.
std::vector<Json> shipped_scenes() {
  std::vector<Json> scenes;
  for (const char* folder : {"/examples", "/tests/scenarios/scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(SPRUNG_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() == ".json") scenes.push_back(Json::parse(std::ifstream(entry.path())));
    }
  }
  // The order of the entries of a folder is undefined.
  std::sort(scenes.begin(), scenes.end(), [](const Json& a, const Json& b) { return a.dump() < b.dump(); });
  return scenes;
}

TEST(SchemaAgreement, BothAcceptTheShippedScenes) {
  const SceneFolder folder;
  const std::vector<Json> scenes = shipped_scenes();
  EXPECT_GE(scenes.size(), 30U);
  for (const Json& scene : scenes) {
    EXPECT_THAT(schema_violations(scene), IsEmpty()) << json_text(scene);
    EXPECT_THAT(problems_of([&] { (void)folder.read(json_text(scene)); }), IsEmpty());
  }
}

TEST(SchemaAgreement, BrokenScenesOfTheRulesAloneBreakRulesBeyondTheSchema) {
  const SceneFolder folder;
  for (const BrokenScene& scene : broken_scenes()) {
    const auto problems = problems_of([&] { (void)folder.read(kPlainScene, scene.changes); });
    const bool all_beyond = std::all_of(problems.begin(), problems.end(), is_beyond_the_schema);
    EXPECT_EQ(all_beyond, !scene.schema_expresses_rule) << scene.name;
  }
}

TEST(SchemaAgreement, EveryRuleBeyondTheSchemaHasABrokenScene) {
  const SceneFolder folder;
  std::set<std::string> broken;
  for (const BrokenScene& scene : broken_scenes()) {
    for (const Problem& problem : problems_of([&] { (void)folder.read(kPlainScene, scene.changes); })) broken.insert(problem.rule);
  }
  for (const auto& category : rules_beyond_the_schema()) {
    for (const std::string& rule : category.second) {
      const auto begins = [&](const std::string& text) { return text.starts_with(rule); };
      EXPECT_TRUE(std::any_of(broken.begin(), broken.end(), begins)) << category.first << ": " << rule;
    }
  }
}

class MutatedScenes : public test::SeededTest {};

TEST_F(MutatedScenes, AreJudgedAlikeBySchemaAndRules) {
  constexpr int kScenes = 500;
  const SceneFolder folder;
  std::vector<Json> valid = shipped_scenes();
  // Two in five mutations change these scenes, which contain every key.
  const std::size_t copies = valid.size() / 3;
  valid.insert(valid.end(), copies, parse_json(kFullScene, "").document);
  valid.insert(valid.end(), copies, parse_json(folder.read(kFullScene).resolved, "").document);
  SceneMutator mutator(valid, static_cast<std::uint32_t>(test::seeded(1)));
  int accepted = 0;
  std::map<std::string, int> used;
  for (int i = 0; i < kScenes; ++i) {
    const MutatedScene scene = mutator.next();
    const Verdict verdict = judge(folder, scene.document);
    EXPECT_EQ(verdict.disagreement, "") << testing::PrintToString(scene.changes);
    if (verdict.accepted_by_schema) ++accepted;
    for (const std::string& name : SceneMutator::mutation_names()) {
      for (const std::string& change : scene.changes) used[name] += change.starts_with(name) ? 1 : 0;
    }
  }
  EXPECT_GT(accepted, kScenes / 20) << "too few scenes are valid to show whether the rules are too strict";
  EXPECT_LT(accepted, kScenes / 2);
  for (const auto& [name, count] : used) EXPECT_GT(count, 5) << name;
}

}  // namespace
}  // namespace sprung
