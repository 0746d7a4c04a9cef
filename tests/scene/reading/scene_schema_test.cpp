// The published schema and the rules know the same keys, and accept the same scenes.
#include "scene/reading/scene_schema.h"

#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::IsSubsetOf;

using Keys = std::set<std::string>;

Json schema() { return Json::parse(scene_schema()); }

/// The node that a reference stands for.
Json resolved(const Json& node) {
  if (!node.contains("$ref")) return node;
  const std::string name = node["$ref"].get<std::string>();
  return schema()["definitions"][name.substr(name.rfind('/') + 1)];
}

bool is_meant(const Json& branch, const Json& instance) {
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

/// An object of a scene: where it is, the keys that the schema allows it, and those that it allows to any choice of its place.
struct ObjectKeys {
  std::string pointer;
  Keys allowed;
  Keys allowed_to_any_choice;
};

void collect(const Json& instance, const Json& unresolved, const std::string& pointer, std::vector<ObjectKeys>& objects) {
  const Json node = resolved(unresolved);
  if (instance.is_array()) {
    for (std::size_t i = 0; i < instance.size(); ++i) {
      collect(instance[i], node.value("items", Json::object()), pointer + "/" + std::to_string(i), objects);
    }
    return;
  }
  if (!instance.is_object()) return;
  Json object = node;
  Keys any;
  if (!node.contains("properties") && node.contains("oneOf")) {
    for (const Json& branch : node["oneOf"]) {
      any.merge(keys_of(branch));
      if (is_meant(branch, instance)) object = branch;
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

/// What the rules offer in place of a key like no other.
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

TEST(SceneSchema, AcceptsWhatTheRulesAccept) {
  const SceneFolder folder;
  for (const char* text : {kPlainScene, kFullScene}) {
    EXPECT_THAT(schema_violations(parse_json(text, "").document), IsEmpty());
    EXPECT_THAT(schema_violations(parse_json(folder.read(text).resolved, "").document), IsEmpty()) << "with defaults filled in";
  }
}

TEST(SceneSchema, KnowsTheKeysOfTheRulesAndNoOthers) {
  const SceneFolder folder;
  const Json scene = parse_json(folder.read(kFullScene).resolved, "").document;
  std::vector<ObjectKeys> objects;
  collect(scene, schema(), "", objects);
  EXPECT_GT(objects.size(), 50U);
  for (const ObjectKeys& object : objects) {
    const Keys known = keys_known_to_rules(folder, scene, object.pointer);
    EXPECT_THAT(object.allowed, IsSubsetOf(known)) << object.pointer;
    EXPECT_THAT(known, IsSubsetOf(object.allowed_to_any_choice)) << object.pointer;
  }
}

TEST(SceneSchema, EveryDefinitionAndKeyIsDescribed) {
  const Json all = schema();
  std::vector<const Json*> open{&all};
  while (!open.empty()) {
    const Json& node = *open.back();
    open.pop_back();
    if (!node.is_structured()) continue;
    for (const Json& entry : node) open.push_back(&entry);
    if (!node.is_object() || !node.contains("properties")) continue;
    for (const auto& property : node["properties"].items()) {
      EXPECT_TRUE(property.value().contains("$ref") || property.value().contains("description")) << property.key();
    }
  }
}

TEST(SceneSchema, IsThePublishedFile) {
  std::ifstream file(std::string(SPRUNG_SOURCE_DIR) + "/src/scene/scene.schema.json");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(scene_schema(), text);
}

TEST(SceneSchema, NamesTheInnermostPlaceThatItRefuses) {
  Json scene = parse_json(kPlainScene, "").document;
  scene["bodies"]["banner"]["springs"]["structural"]["damping"] = -1;
  EXPECT_THAT(schema_violations(scene), ElementsAre(Field(&SchemaViolation::path, "bodies.banner.springs.structural.damping")));
  scene = parse_json(kPlainScene, "").document;
  scene["bodies"]["banner"]["shape"]["size"][1] = "wide";
  EXPECT_THAT(schema_violations(scene), ElementsAre(Field(&SchemaViolation::path, "bodies.banner.shape")))
      << "of a choice the choice itself: what its other branches say of the place means nothing";
}

}  // namespace
}  // namespace sprung
