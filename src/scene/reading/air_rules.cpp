#include "scene/reading/scene_rules.h"

#include <limits>
#include <utility>

namespace sprung {
namespace {

using WindKeyframes = std::vector<WindKeyframe>;

WindKeyframe read_keyframe(Fields& fields) {
  return {.time = fields.required("time", number()).value_or(0.0),
          .velocity = fields.required("velocity", vector3()).value_or(Vector3::Zero())};
}

std::optional<WindKeyframes> read_keyframes(Fields& fields) {
  auto keyframes = fields.required("keyframes", list_of(object_of<WindKeyframe>(read_keyframe), 1));
  if (!keyframes) return std::nullopt;
  std::vector<double> times;
  for (const WindKeyframe& keyframe : *keyframes) times.push_back(keyframe.time);
  require_increasing_times(times, fields.location());
  return keyframes;
}

/// A constant velocity, or an object with keyframes.
Rule<WindKeyframes> wind_rule() {
  return [](Json& json, const JsonLocation& location) -> std::optional<WindKeyframes> {
    if (json.is_object()) return object_of<WindKeyframes>(read_keyframes)(json, location);
    const auto velocity = vector3()(json, location);
    if (!velocity) return std::nullopt;
    return WindKeyframes{{.time = 0.0, .velocity = *velocity}};
  };
}

Gusts read_gusts(Fields& fields) {
  Gusts gusts;
  gusts.speed = fields.required("speed", number(kNotNegative)).value_or(0.0);
  gusts.length = fields.required("length", number(kPositive)).value_or(1.0);
  gusts.seed = static_cast<std::uint64_t>(fields.value("seed", integer(0, std::numeric_limits<Index>::max()), 0).value_or(0));
  return gusts;
}

SurfaceDrag read_surface(Fields& fields) {
  SurfaceDrag surface;
  surface.normal = fields.value("normal", number(kNotNegative), 0.0).value_or(0.0);
  surface.tangential = fields.value("tangential", number(kNotNegative), 0.0).value_or(0.0);
  surface.quadratic = fields.value("quadratic", boolean(), false).value_or(false);
  return surface;
}

}  // namespace

void read_air(Fields& fields, Scene& scene) {
  SimulatorSettings& settings = scene.settings;
  scene.air_of_materials = !fields.has("drag") && !fields.has("surface");
  settings.air_drag = fields.optional("drag", number(kNotNegative)).value_or(0.0);
  settings.air_surface = fields.optional("surface", object_of<SurfaceDrag>(read_surface)).value_or(SurfaceDrag{});
  const auto gusts = fields.optional("gusts", object_of<Gusts>(read_gusts));
  settings.wind = Wind(fields.value("wind", wind_rule(), {0, 0, 0}).value_or(WindKeyframes{}), gusts);
}

}  // namespace sprung
