#include "scene/format/file_wildcard.h"
#include "scene/reading/scene_rules.h"

namespace sprung {
namespace {

double length(Fields& fields, const std::string& key) { return fields.required(key, number(kPositive)).value_or(0.0); }

HalfSpaceGeometry read_half_space(Fields& fields) {
  HalfSpaceGeometry half_space;
  if (const auto normal = fields.value("normal", vector3(), {0, 1, 0})) {
    // The normal may have any length, but the square of a very short one is 0.
    if (normal->isZero(0.0)) {
      fields.location().at("normal").report(fields.json()["normal"], "must not be zero", "the normal points out of the solid side");
    } else {
      half_space.normal = normal->stableNormalized();
    }
  }
  half_space.offset = fields.value("offset", number(), 0.0).value_or(0.0);
  return half_space;
}

std::optional<std::variant<std::vector<std::string>, std::string>> read_files(Json& json, const JsonLocation& location) {
  if (json.is_string()) {
    if (is_wildcard(json.get_ref<const std::string&>())) return json.get<std::string>();
    location.report(json, "must have one * in the name of the file", "write a pattern like \"breath/*.obj\", or a list of files");
    return std::nullopt;
  }
  if (json.is_array()) return list_of(text(), 2)(json, location);
  location.report(json, "must be a list of files, or a pattern with one *");
  return std::nullopt;
}

MeshFiles read_sequence(Fields& fields, double frame_rate) {
  MeshFiles sequence;
  using Files = decltype(sequence.files);
  sequence.files = fields.required<Files>("files", read_files).value_or(Files{});
  sequence.frame_rate = fields.value("frame_rate", number(kPositive), frame_rate).value_or(frame_rate);
  sequence.start = fields.value("start", number(), 0.0).value_or(0.0);
  sequence.loop = fields.value("loop", boolean(), false).value_or(false);
  return sequence;
}

/// Shapes that other programs have, and those of bodies.
WordRemedies remedies_of_other_shapes() {
  WordRemedies remedies{{"ball", "did you mean \"sphere\"?"}, {"cube", "did you mean \"box\"?"}};
  for (const char* floor : {"plane", "floor", "ground"}) remedies[floor] = "did you mean \"half_space\"? A plate is a \"box\"";
  for (const char* body : {"rope", "cloth", "solid", "lattice", "tetrahedra"}) {
    remedies[body] = "only a body may be one: move it to bodies. A rigid mesh is a \"mesh\" of a file with its surface";
  }
  return remedies;
}

ObstacleShapeScene read_shape(Fields& fields, double frame_rate) {
  const auto kind =
      fields.kind("type", {"mesh", "sequence", "sphere", "box", "capsule", "cylinder", "cone", "ellipsoid", "half_space"},
                  remedies_of_other_shapes());
  if (!kind) return {};
  switch (*kind) {
    case 0:
      return MeshFile{fields.required("file", text()).value_or("")};
    case 1:
      return read_sequence(fields, frame_rate);
    case 2:
      return SphereGeometry{length(fields, "radius")};
    case 3:
      fields.set_remedy({"width", "height", "depth", "length"}, "did you mean \"size\": [X, Y, Z]?");
      return BoxGeometry{fields.required("size", vector3(kPositive)).value_or(Vector3::Zero())};
    case 4:
      fields.set_remedy({"height"}, "did you mean \"length\"?");
      return CapsuleGeometry{length(fields, "radius"), length(fields, "length")};
    case 5:
      fields.set_remedy({"length"}, "did you mean \"height\"?");
      return CylinderGeometry{length(fields, "radius"), length(fields, "height")};
    case 6:
      fields.set_remedy({"length"}, "did you mean \"height\"?");
      return ConeGeometry{length(fields, "radius"), length(fields, "height")};
    case 7:
      return EllipsoidGeometry{fields.required("radii", vector3(kPositive)).value_or(Vector3::Zero())};
    default:
      return read_half_space(fields);
  }
}

ObstacleScene read_obstacle(Fields& fields, double frame_rate) {
  ObstacleScene obstacle;
  set_remedies_of_place(fields);
  fields.set_owner({"type", "file", "size", "radius"}, "shape");
  fields.set_owner({"keyframes", "spin"}, "motion");
  const auto shape = object_of<ObstacleShapeScene>([=](Fields& of_shape) { return read_shape(of_shape, frame_rate); });
  obstacle.shape = fields.required("shape", shape).value_or(ObstacleShapeScene{});
  obstacle.place = fields.value("place", placement_rule(), Json::object()).value_or(Placement{});
  obstacle.motion = fields.value("motion", motion_rule(), Json::object()).value_or(Motion{});
  obstacle.material = read_material(fields);
  return obstacle;
}

}  // namespace

Rule<ObstacleScene> obstacle_rule(double frame_rate) {
  return object_of<ObstacleScene>([=](Fields& fields) { return read_obstacle(fields, frame_rate); });
}

}  // namespace sprung
