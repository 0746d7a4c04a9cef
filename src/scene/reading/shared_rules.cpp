#include "scene/reading/scene_rules.h"

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

}  // namespace sprung
