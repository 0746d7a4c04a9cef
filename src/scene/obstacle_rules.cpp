#include "scene/scene_rules.h"

namespace sprung {
namespace {

double length(Fields& fields, const std::string& key) { return fields.required(key, number(kPositive)).value_or(0.0); }

HalfSpaceGeometry read_half_space(Fields& fields) {
  HalfSpaceGeometry half_space;
  if (const auto normal = fields.value("normal", vector3(), {0, 1, 0})) {
    // Any length will do, but the square of a very short one is 0.
    if (normal->isZero(0.0)) {
      fields.place().at("normal").report(fields.json()["normal"], "must not be zero", "it points out of the solid side");
    } else {
      half_space.normal = normal->stableNormalized();
    }
  }
  half_space.offset = fields.value("offset", number(), 0.0).value_or(0.0);
  return half_space;
}

ObstacleShapeScene read_shape(Fields& fields) {
  const auto kind = fields.kind("type", {"mesh", "sphere", "box", "capsule", "cylinder", "cone", "ellipsoid", "half_space"});
  if (!kind) return {};
  switch (*kind) {
    case 0:
      return MeshFile{fields.required("file", text()).value_or("")};
    case 1:
      return SphereGeometry{length(fields, "radius")};
    case 2:
      return BoxGeometry{fields.required("size", vector3(kPositive)).value_or(Vector3::Zero())};
    case 3:
      return CapsuleGeometry{length(fields, "radius"), length(fields, "length")};
    case 4:
      return CylinderGeometry{length(fields, "radius"), length(fields, "height")};
    case 5:
      return ConeGeometry{length(fields, "radius"), length(fields, "height")};
    case 6:
      return EllipsoidGeometry{fields.required("radii", vector3(kPositive)).value_or(Vector3::Zero())};
    default:
      return read_half_space(fields);
  }
}

ObstacleScene read_obstacle(Fields& fields) {
  ObstacleScene obstacle;
  obstacle.shape = fields.required("shape", object_of<ObstacleShapeScene>(read_shape)).value_or(ObstacleShapeScene{});
  obstacle.place = fields.value("place", placement_rule(), Json::object()).value_or(Placement{});
  obstacle.motion = fields.value("motion", motion_rule(), Json::object()).value_or(Motion{});
  obstacle.material = read_material(fields);
  return obstacle;
}

}  // namespace

Rule<ObstacleScene> obstacle_rule() { return object_of<ObstacleScene>(read_obstacle); }

}  // namespace sprung
