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
  const std::optional<Import>& imported = import(*file);
  if (!imported) return std::nullopt;
  const double scale = obstacle.place.scale;
  reports_.push_back({obstacle.name, *file, imported->report});
  if (auto note = unit_note(imported->report.bounds, scale)) reports_.back().report.notes.push_back(std::move(*note));
  if (scale == 1.0) return MeshGeometry{imported->mesh, imported->report.closed};
  TriangleMesh larger = *imported->mesh;
  larger.vertices *= scale;
  return MeshGeometry{std::make_shared<const TriangleMesh>(std::move(larger)), imported->report.closed};
}

const std::optional<ObstacleBuilder::Import>& ObstacleBuilder::import(const std::filesystem::path& file) {
  const auto [place, is_new] = imports_.try_emplace(file);
  if (!is_new) return place->second;
  try {
    ImportedMesh imported = import_mesh(file);
    place->second = Import{std::make_shared<const TriangleMesh>(std::move(imported.mesh)), std::move(imported.report)};
  } catch (const InputError& error) {
    problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
  }
  return place->second;
}

}  // namespace sprung
