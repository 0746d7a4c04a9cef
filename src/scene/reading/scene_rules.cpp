#include "scene/reading/scene_rules.h"

#include "base/format.h"
#include "scene/json/nearest_name.h"
#include "simulation/step/frame_steps.h"

#include <algorithm>
#include <cctype>

namespace sprung {
namespace {

// File systems limit names to 255 bytes, including the number of a frame and the extension.
constexpr std::size_t kLongestName = 200;

void check_name(const std::string& name, const JsonLocation& location) {
  if (name == "obstacles") location.report_key("the name is reserved for the folder of the obstacles", "choose another name");
  if (is_name(name)) return;
  location.report_key("a name becomes a folder: it may have at most 200 letters, digits, _ and -", "choose another name");
}

/// An object keyed by name: reads each entry by `rule`, and checks and sets its name.
template <class T>
Rule<std::vector<T>> named(Rule<T> rule, bool may_be_empty) {
  return [=](Json& json, const JsonLocation& location) -> std::optional<std::vector<T>> {
    if (!check_object(json, location)) return std::nullopt;
    if (json.empty() && !may_be_empty) location.report(json, "must have at least one entry");
    std::vector<T> entries;
    for (const auto& item : json.items()) {
      const JsonLocation at = location.at(item.key());
      check_name(item.key(), at);
      if (auto entry = rule(item.value(), at)) {
        entry->name = item.key();
        entries.push_back(std::move(*entry));
      }
    }
    return entries;
  };
}

/// A step [s]; none for "auto".
struct StepScene {
  std::optional<double> step;
};

std::optional<StepScene> read_step(Json& json, const JsonLocation& location) {
  if (json == "auto") return StepScene{};
  if (!json.is_number()) {
    location.report(json, "must be a number of seconds, or \"auto\"");
    return std::nullopt;
  }
  const auto step = number(kPositive)(json, location);
  if (!step) return std::nullopt;
  return StepScene{*step};
}

std::optional<double> read_mass_scaling(Json& json, const JsonLocation& location) {
  if (json.is_boolean()) return json.get<bool>() ? kMassScaling : 0.0;
  if (json.is_number()) return number(kFraction)(json, location);
  location.report(json, "must be true, false or the largest share of a body's mass that may be added, from 0 to 1");
  return std::nullopt;
}

void read_time(Fields& fields, Scene& scene) {
  const auto duration = fields.required("duration", number(kNotNegative));
  const auto frame_rate = fields.value("frame_rate", number(kPositive), scene.frame_rate);
  const auto step = fields.value<StepScene>("step", read_step, "auto");
  scene.mass_scaling = fields.value<double>("mass_scaling", read_mass_scaling, true).value_or(scene.mass_scaling);
  scene.duration = duration.value_or(0.0);
  scene.frame_rate = frame_rate.value_or(scene.frame_rate);
  scene.settings.frame_rate = scene.frame_rate;  // so that messages advise steps that divide a frame
  if (step) scene.step = step->step;
  if (duration && frame_rate && *duration * *frame_rate > kMostFrames) {
    fields.location()
        .at("duration")
        .report(Json(*duration), "makes more than " + format_number(kMostFrames) + " frames of 1 / frame_rate",
                "lower one of them");
  }
}

// Penalty contact acts only between bodies and obstacles.
void check_self_contact(const Scene& scene, const JsonLocation& location) {
  if (scene.settings.contact.response != ContactSettings::Response::penalty) return;
  for (const BodyScene& body : scene.bodies) {
    if (!body.contact.self) continue;
    location.at("bodies")
        .at(body.name)
        .at("self_contact")
        .report(Json(true), "needs contact.response \"projection\"", "use that, or set it to false");
  }
}

// The obstacle may have problems of its own, so the names are those of the text.
void check_followed(const Scene& scene, const Json& obstacles, const JsonLocation& location) {
  if (!obstacles.is_object()) return;
  std::vector<std::string> names;
  for (const auto& obstacle : obstacles.items()) names.push_back(obstacle.key());
  for (const BodyScene& body : scene.bodies) {
    const JsonLocation pins = location.at("bodies").at(body.name).at("pins");
    for (std::size_t p = 0; p < body.pins.size(); ++p) {
      const std::string& name = body.pins[p].follow;
      if (name.empty() || std::ranges::find(names, name) != names.end()) continue;
      pins.at(p).at("follow").report(Json(name), "must be the name of an obstacle",
                                     names.empty() ? "the scene has none" : suggestion(name, names));
    }
  }
}

bool has_material(const Json& bodies) {
  return bodies.is_object() && std::ranges::any_of(bodies, [](const Json& body) { return body.contains("material"); });
}

/// Remedies for keys of `air` at the top level. Wind has no effect without a drag or a material: the remedy then names a drag too.
void set_remedies_of_air(Fields& fields) {
  fields.set_owner({"drag", "gusts", "surface", "wind"}, "air");
  const Json air = fields.json().value("air", Json());
  if (air.contains("drag") || air.contains("surface") || has_material(fields.json().value("bodies", Json()))) return;
  for (const std::string key : {"gusts", "wind"}) {
    fields.set_remedy({key}, "it belongs to air and acts by a drag: write \"air\": { \"" + key + "\": ..., \"drag\": ... }");
  }
}

Scene read_scene_fields(Fields& fields) {
  Scene scene;
  set_remedies_of_air(fields);
  fields.set_remedy({"dt", "time_step", "timestep"}, "did you mean \"step\"?");
  fields.set_remedy({"fps"}, "did you mean \"frame_rate\"?");
  fields.optional("$schema", text());
  fields.value("version", integer(1, 1), 1);
  read_time(fields, scene);
  scene.initial_state = fields.optional("initial_state", text()).value_or("");
  scene.bodies = fields.required("bodies", named(body_rule(), false)).value_or(std::vector<BodyScene>{});
  read_settings(fields, scene);
  check_self_contact(scene, fields.location());
  const auto obstacles = fields.value("obstacles", named(obstacle_rule(scene.frame_rate), true), Json::object());
  scene.obstacles = obstacles.value_or(std::vector<ObstacleScene>{});
  const Json named_bodies = fields.json().value("bodies", Json());
  const Json named_obstacles = fields.json().value("obstacles", Json());
  check_followed(scene, named_obstacles, fields.location());
  const auto attachment = attachment_rule(scene, named_bodies, named_obstacles);
  scene.attachments = fields.value("attachments", list_of(attachment, 0), Json::array()).value_or(std::vector<AttachmentScene>{});
  return scene;
}

}  // namespace

bool is_name(const std::string& name) {
  const auto allowed = [](unsigned char letter) {
    return (letter < 128 && std::isalnum(letter)) || letter == '_' || letter == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), allowed);
}

Rule<Scene> scene_rule() { return object_of<Scene>(read_scene_fields); }

}  // namespace sprung
