// The rules of the objects of a scene, one table per kind of object: key, type, bounds, default. scene.schema.json explains the
// keys.
#pragma once

#include "scene/format/scene.h"
#include "scene/json/json_fields.h"

namespace sprung {

[[nodiscard]] Rule<Placement> placement_rule();

/// The remedies for keys of `place`, under its names or those of other programs, beside it.
void set_remedies_of_place(Fields& fields);

[[nodiscard]] Rule<Motion> motion_rule();

/// Reports each time of keyframes that is not later than the one before it. `location` is that of the object with the keyframes.
void require_increasing_times(const std::vector<double>& times, const JsonLocation& location);

/// thickness, friction, static_friction, restitution.
[[nodiscard]] ContactMaterial read_material(Fields& fields);

/// What selectors may name in a body of some shape.
struct NamedParts {
  std::vector<std::string> corners{};
  bool groups = false;  ///< whether it is a mesh
};

/// What selectors may name in a body of this shape; in any shape if it is invalid.
[[nodiscard]] NamedParts named_parts(const std::optional<BodyShapeScene>& shape);

/// The one selector of an object; none if there is none or it is invalid.
[[nodiscard]] std::optional<Selector> read_selector(Fields& fields, const NamedParts& parts);

/// Whether an object has a selector.
[[nodiscard]] bool has_selector(Fields& fields);

/// The times from and until [s] of a pin or an attachment.
void read_times(Fields& fields, double& from, double& until);

/// The name of an entry of `entries`, which is "a body" or "an obstacle". Accepts any name if `entries` is no object, which is
/// reported elsewhere.
[[nodiscard]] Rule<std::string> name_of(const Json& entries, const std::string& entry);

/// Whether a name has 1 to 200 letters, digits, _ and -.
[[nodiscard]] bool is_name(const std::string& name);

/// Pins and point masses of a body.
[[nodiscard]] Rule<PinScene> pin_rule(const NamedParts& parts);
[[nodiscard]] Rule<PointMassScene> point_mass_rule(const NamedParts& parts);

/// A body or an obstacle, without its name. `frame_rate` is the default of sequences.
[[nodiscard]] Rule<BodyScene> body_rule();
[[nodiscard]] Rule<ObstacleScene> obstacle_rule(double frame_rate);

/// drag, surface, wind, gusts.
void read_air(Fields& fields, Scene& scene);

/// gravity, air, integrator, stretch_limit, contact, stability, output and others. Without a `stretch_limit`, the bodies that need
/// one for their materials get it. Requires the scene's bodies.
void read_settings(Fields& fields, Scene& scene);

/// Requires the bodies of the scene, and the texts of bodies and obstacles.
[[nodiscard]] Rule<AttachmentScene> attachment_rule(const Scene& scene, const Json& bodies, const Json& obstacles);

/// The whole document.
[[nodiscard]] Rule<Scene> scene_rule();

}  // namespace sprung
