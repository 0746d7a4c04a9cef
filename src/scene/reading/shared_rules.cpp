#include "base/format.h"
#include "scene/json/nearest_name.h"
#include "scene/reading/scene_rules.h"

#include <algorithm>

namespace sprung {
namespace {

Keyframe read_keyframe(Fields& fields) {
  Keyframe keyframe;
  keyframe.time = fields.required("time", number()).value_or(0.0);
  keyframe.position = fields.value("position", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  keyframe.rotation = fields.value("rotation", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  return keyframe;
}

Motion read_motion(Fields& fields) {
  Motion motion;
  if (const auto keyframes = fields.optional("keyframes", list_of(object_of<Keyframe>(read_keyframe), 1))) {
    motion.keyframes = *keyframes;
    std::vector<double> times;
    for (const Keyframe& keyframe : *keyframes) times.push_back(keyframe.time);
    require_increasing_times(times, fields.location());
  }
  const auto interpolation = fields.value("interpolation", word_of({"linear", "smooth"}), "linear");
  motion.interpolation = interpolation == 1 ? Interpolation::smooth : Interpolation::linear;
  motion.spin = fields.value("spin", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  return motion;
}

Placement read_placement(Fields& fields) {
  fields.set_remedy({"translate", "translation"}, "did you mean \"position\"?");
  Placement placement;
  placement.position = fields.value("position", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  placement.rotation = fields.value("rotation", vector3(), {0, 0, 0}).value_or(Vector3::Zero());
  placement.scale = fields.value("scale", number(kPositive), 1.0).value_or(1.0);
  return placement;
}

}  // namespace

void require_increasing_times(const std::vector<double>& times, const JsonLocation& location) {
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (times[k] > times[k - 1]) continue;
    location.at("keyframes")
        .at(k)
        .at("time")
        .report(Json(times[k]), "must be later than the keyframe before it", "sort the keyframes by time");
  }
}

void set_remedies_of_place(Fields& fields) {
  fields.set_owner({"position", "rotation", "scale"}, "place");
  fields.set_remedy({"translate", "translation"}, "did you mean \"place\": { \"position\": ... }?");
}

Rule<Placement> placement_rule() { return object_of<Placement>(read_placement); }

Rule<Motion> motion_rule() { return object_of<Motion>(read_motion); }

ContactMaterial read_material(Fields& fields) {
  ContactMaterial material;
  material.thickness = fields.value("thickness", number(kNotNegative), 0.0).value_or(0.0);
  const auto friction = fields.value("friction", number(kNotNegative), 0.0);
  const auto static_friction = fields.value("static_friction", number(kNotNegative), friction.value_or(0.0));
  if (friction && static_friction && *static_friction < *friction) {
    fields.location().at("static_friction").report(Json(*static_friction), "must be at least friction, " + shortened(*friction));
  }
  material.friction = friction.value_or(0.0);
  material.static_friction = static_friction.value_or(0.0);
  material.restitution = fields.value("restitution", number(kFraction), 0.0).value_or(0.0);
  return material;
}

void read_times(Fields& fields, double& from, double& until) {
  const auto begin = fields.value("from", number(kNotNegative), 0.0);
  const auto end = fields.optional("until", number(kNotNegative));
  from = begin.value_or(from);
  until = end.value_or(until);
  if (begin && end && !(*end > *begin)) {
    fields.location().at("until").report(Json(*end), "must be later than from, " + format_number(*begin) + " s",
                                         "from is when it begins, until when it ends");
  }
}

Rule<std::string> name_of(const Json& entries, const std::string& entry) {
  std::vector<std::string> names;
  if (!entries.is_object()) return text();
  for (const auto& named : entries.items()) names.push_back(named.key());
  return [=](Json& json, const JsonLocation& location) -> std::optional<std::string> {
    const auto name = text()(json, location);
    if (!name || std::ranges::find(names, *name) != names.end()) return name;
    location.report(json, "must be the name of " + entry, names.empty() ? "the scene has none" : suggestion(*name, names));
    return std::nullopt;
  };
}

}  // namespace sprung
