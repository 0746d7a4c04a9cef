#include "scene/building/unlikely_settings.h"

#include "scene/building/body_builder.h"

#include <algorithm>
#include <array>
#include <functional>

namespace sprung {
namespace {

double extent_of(const Box3& box) { return box.isEmpty() ? 0.0 : box.sizes().maxCoeff(); }

/// A body or an obstacle.
struct Thing {
  std::string name;
  Box3 bounds;  ///< before its placement rotates it [m], with its scale
  double scale = 1.0;
  bool is_mesh = false;
  GroupedWarnings* warnings = nullptr;
};

/// By the order of bodies in the scene, of which each is in the network.
Thing thing_of(const BodyScene& body, const SpringNetwork& network, GroupedWarnings& warnings) {
  const auto built = std::ranges::find(network.bodies, body.name, &Body::name);
  const auto placed = network.positions.middleCols(built->first_particle, built->particle_count);
  const bool is_mesh = std::holds_alternative<MeshFile>(body.shape) || std::holds_alternative<LatticeFile>(body.shape) ||
                       std::holds_alternative<TetrahedraFile>(body.shape);
  return {body.name, bounds(pose_of(body.place).inverse() * placed), body.place.scale, is_mesh, &warnings};
}

Thing thing_of(const ObstacleScene& obstacle, const Obstacle& built, GroupedWarnings& warnings) {
  const bool is_mesh = std::holds_alternative<MeshFile>(obstacle.shape) || std::holds_alternative<MeshFiles>(obstacle.shape);
  const double half_space_extent = 0.0;
  return {obstacle.name, bounds(obstacle_mesh(built.geometry, half_space_extent).vertices), obstacle.place.scale, is_mesh,
          &warnings};
}

bool has_springs(const SpringNetwork& network, const Body& body, SpringKind kind) {
  const auto first = network.springs.kind.begin() + body.first_spring;
  return std::find(first, first + body.spring_count, kind) != first + body.spring_count;
}

}  // namespace

void note_unusual_sizes(const Scene& scene, const BuiltScene& built, GroupedWarnings& bodies, GroupedWarnings& obstacles) {
  std::vector<Thing> things;
  for (const BodyScene& body : scene.bodies) things.push_back(thing_of(body, built.network, bodies));
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    things.push_back(thing_of(scene.obstacles[k], built.obstacles[k], obstacles));
  for (const Thing& thing : things) {
    if (!thing.is_mesh) continue;
    double others = 0.0;
    for (const Thing& other : things) {
      if (&other != &thing) others = std::max(others, extent_of(other.bounds));
    }
    const Box3 as_in_file(thing.bounds.min() / thing.scale, thing.bounds.max() / thing.scale);
    if (const auto note = unit_note(as_in_file, thing.scale, others)) thing.warnings->add(thing.name, *note);
  }
}

void note_unused_springs(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies) {
  for (const BodyScene& body : scene.bodies) {
    if (!body.preset.empty()) continue;  // a material has springs for every shape
    const Body& built = *std::ranges::find(network.bodies, body.name, &Body::name);
    const std::array<const std::optional<SpringMaterial>*, 3> materials{&body.springs.structural, &body.springs.shear,
                                                                        &body.springs.bend};
    for (const SpringKind kind : {SpringKind::structural, SpringKind::shear, SpringKind::bend}) {
      const auto index = static_cast<std::size_t>(kind);
      if (!*materials[index] || has_springs(network, built, kind)) continue;
      if (kind == SpringKind::bend && built.angle_bend_count > 0) continue;
      bodies.add(body.name, std::string("springs.") + kSpringKindNames[index] + " has no effect: its shape has no such springs");
    }
  }
}

}  // namespace sprung
