// The rules of the objects of a scene, one table per kind of object: key, type, bounds, default. scene.schema.json explains the
// keys.
#pragma once

#include "scene/format/scene.h"
#include "scene/json/json_fields.h"

namespace sprung {

[[nodiscard]] Rule<Placement> placement_rule();
[[nodiscard]] Rule<Motion> motion_rule();

/// thickness, friction, static_friction, restitution.
[[nodiscard]] ContactMaterial read_material(Fields& fields);

/// Pins of a body; `corners` are the names of the corners of its shape.
[[nodiscard]] Rule<PinScene> pin_rule(const std::vector<std::string>& corners);

/// A body or an obstacle, without its name. `frame_rate` is the default of sequences.
[[nodiscard]] Rule<BodyScene> body_rule();
[[nodiscard]] Rule<ObstacleScene> obstacle_rule(double frame_rate);

/// gravity, air, integrator, stretch_limit, contact, stability. Without a `stretch_limit`, the bodies that need one for their
/// materials get it. Requires the scene's bodies.
void read_settings(Fields& fields, Scene& scene);

/// The whole document.
[[nodiscard]] Rule<Scene> scene_rule();

}  // namespace sprung
