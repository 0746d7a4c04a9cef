#include "scene/obstacle_builder.h"

#include "scene/body_builder.h"
#include "scene/json_text.h"

#include <utility>

namespace sprung {
namespace {

ObstacleGeometry scaled(const SphereGeometry& sphere, double scale) { return SphereGeometry{scale * sphere.radius}; }
ObstacleGeometry scaled(const BoxGeometry& box, double scale) { return BoxGeometry{scale * box.size}; }
ObstacleGeometry scaled(const CapsuleGeometry& capsule, double scale) {
  return CapsuleGeometry{scale * capsule.radius, scale * capsule.length};
}
ObstacleGeometry scaled(const CylinderGeometry& cylinder, double scale) {
  return CylinderGeometry{scale * cylinder.radius, scale * cylinder.height};
}
ObstacleGeometry scaled(const ConeGeometry& cone, double scale) { return ConeGeometry{scale * cone.radius, scale * cone.height}; }
ObstacleGeometry scaled(const EllipsoidGeometry& ellipsoid, double scale) { return EllipsoidGeometry{scale * ellipsoid.radii}; }
ObstacleGeometry scaled(const HalfSpaceGeometry& half_space, double scale) {
  return HalfSpaceGeometry{half_space.normal, scale * half_space.offset};
}

}  // namespace

template <class Primitive>
std::optional<ObstacleGeometry> ObstacleBuilder::geometry_of(const ObstacleScene& obstacle, const Primitive& primitive) const {
  return scaled(primitive, obstacle.place.scale);
}

std::optional<Obstacle> ObstacleBuilder::build(const ObstacleScene& obstacle) {
  const auto make = [&](const auto& shape) { return geometry_of(obstacle, shape); };
  std::optional<ObstacleGeometry> geometry = std::visit(make, obstacle.shape);
  if (!geometry) return std::nullopt;
  return Obstacle{obstacle.name, std::move(*geometry), pose_of(obstacle.place), obstacle.motion, obstacle.material};
}

std::optional<ObstacleGeometry> ObstacleBuilder::geometry_of(const ObstacleScene& obstacle, const MeshFile& mesh) {
  const auto file = finder_.find(mesh.file, join_path("obstacles", obstacle.name) + ".shape.file", problems_);
  if (!file) return std::nullopt;
  try {
    const Import& imported = import(*file);
    reports_.push_back({obstacle.name, *file, imported.report});
    if (obstacle.place.scale == 1.0) return MeshGeometry{imported.mesh, imported.report.closed};
    TriangleMesh larger = *imported.mesh;
    larger.vertices *= obstacle.place.scale;
    return MeshGeometry{std::make_shared<const TriangleMesh>(std::move(larger)), imported.report.closed};
  } catch (const InputError& error) {
    problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
    return std::nullopt;
  }
}

const ObstacleBuilder::Import& ObstacleBuilder::import(const std::filesystem::path& file) {
  const auto known = imports_.find(file);
  if (known != imports_.end()) return known->second;
  ImportedMesh imported = import_mesh(file);
  Import import{std::make_shared<const TriangleMesh>(std::move(imported.mesh)), std::move(imported.report)};
  return imports_.emplace(file, std::move(import)).first->second;
}

}  // namespace sprung
