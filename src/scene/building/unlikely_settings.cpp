#include "scene/building/unlikely_settings.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "geometry/mesh/mesh_faults.h"
#include "geometry/mesh/weld.h"
#include "scene/building/body_builder.h"
#include "scene/materials/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace sprung {
namespace {

constexpr int kDigits = 3;

double extent_of(const Box3& box) { return box.isEmpty() ? 0.0 : box.sizes().maxCoeff(); }

/// The body in the network. Requires one of this name.
const Body& built_body(const SpringNetwork& network, const BodyScene& body) {
  return *std::ranges::find(network.bodies, body.name, &Body::name);
}

Points positions_of(const SpringNetwork& network, const Body& body) {
  return network.positions.middleCols(body.first_particle, body.particle_count);
}

/// A body or an obstacle.
struct Thing {
  std::string name;
  Box3 bounds;  ///< before its placement rotates it [m], with its scale
  double scale = 1.0;
  bool is_mesh = false;
  bool is_obstacle = false;
  GroupedWarnings* warnings = nullptr;
};

/// By the order of bodies in the scene, of which each is in the network.
Thing thing_of(const BodyScene& body, const SpringNetwork& network, GroupedWarnings& warnings) {
  const Points placed = positions_of(network, built_body(network, body));
  const bool is_mesh = std::holds_alternative<MeshFile>(body.shape) || std::holds_alternative<LatticeFile>(body.shape) ||
                       std::holds_alternative<TetrahedraFile>(body.shape);
  return {body.name, bounds(pose_of(body.place).inverse() * placed), body.place.scale, is_mesh, false, &warnings};
}

Thing thing_of(const ObstacleScene& obstacle, const Obstacle& built, GroupedWarnings& warnings) {
  const bool is_mesh = std::holds_alternative<MeshFile>(obstacle.shape) || std::holds_alternative<MeshFiles>(obstacle.shape);
  const double half_space_extent = 0.0;
  return {obstacle.name, bounds(obstacle_mesh(built.geometry, half_space_extent).vertices), obstacle.place.scale, is_mesh, true,
          &warnings};
}

/// A floor, a wall or a landscape may be far wider than a body, so that the least side counts as the size of an obstacle.
OtherSizes sizes_of_others(const std::vector<Thing>& things, const Thing& thing) {
  OtherSizes sizes;
  for (const Thing& other : things) {
    const double extent = extent_of(other.bounds);
    if (&other == &thing || extent == 0.0) continue;
    const double size = other.is_obstacle ? other.bounds.sizes().minCoeff() : extent;
    sizes.largest = std::max(sizes.largest, extent);
    if (size > 0.0) sizes.smallest = sizes.smallest == 0.0 ? size : std::min(sizes.smallest, size);
  }
  return sizes;
}

/// The densities of all materials for bodies with this dimension [kg/m^dimension].
std::pair<double, double> range_of_densities(int dimension) {
  const std::array kinds{MaterialKind::rope, MaterialKind::cloth, MaterialKind::solid};
  std::pair<double, double> range{std::numeric_limits<double>::infinity(), 0.0};
  for (const Material& material : materials()) {
    if (material.kind != kinds.at(static_cast<std::size_t>(dimension) - 1)) continue;
    const double density = material.find("density")->value;
    range = {std::min(range.first, density), std::max(range.second, density)};
  }
  return range;
}

/// The mass of a body without its point masses [kg].
double own_mass(const MassScene& mass, const Body& body) {
  switch (mass.kind) {
    case MassScene::Kind::body:
      return mass.value;
    case MassScene::Kind::particle:
      return mass.value * static_cast<double>(body.particle_count - body.contact_only);
    case MassScene::Kind::density:
      return mass.value * body.measure;
  }
  return 0.0;
}

double mean_edge(const Surface& surface, const Points& positions) {
  double sum = 0.0;
  Index count = 0;
  const auto add = [&](Index a, Index b) {
    sum += (positions.col(a) - positions.col(b)).norm();
    ++count;
  };
  for (const auto& corners : surface.triangles.colwise()) {
    for (Index k = 0; k < 3; ++k) add(corners[k], corners[(k + 1) % 3]);
  }
  for (const auto& ends : surface.segments.colwise()) add(ends[0], ends[1]);
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

constexpr double kRounding = 1e-9;  // of placements and of directions that users type

bool is_across(const Vector3& vector, const Vector3& normal) { return std::abs(vector.dot(normal)) > kRounding * vector.norm(); }

/// The normal of a body whose particles lie and move in one plane; none for all others.
std::optional<Vector3> normal_of_sheet(const SpringNetwork& network, const Body& body) {
  const Triangles& triangles = body.surface.triangles;
  if (triangles.cols() == 0 || body.dimension != 2) return std::nullopt;
  const Points x = positions_of(network, body);
  const Vector3 origin = x.col(triangles(0, 0));
  const Vector3 normal = (x.col(triangles(1, 0)) - origin).cross(x.col(triangles(2, 0)) - origin).normalized();
  const double extent = extent_of(bounds(x));
  for (Index i = 0; i < body.particle_count; ++i) {
    if (std::abs(normal.dot(x.col(i) - origin)) > kRounding * extent) return std::nullopt;
    if (is_across(network.velocities.col(body.first_particle + i), normal)) return std::nullopt;
  }
  return normal;
}

bool has_moving_pin(const SpringNetwork& network, const Body& body) {
  const auto moves = [&](const Pin& pin) { return pin.moves() && &network.body_of(pin.particles.front()) == &body; };
  return std::ranges::any_of(network.pins, moves);
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
    const OtherSizes others = sizes_of_others(things, thing);
    const Box3 as_in_file(thing.bounds.min() / thing.scale, thing.bounds.max() / thing.scale);
    const SizeSource source = thing.is_mesh ? SizeSource::file : SizeSource::shape;
    auto note = unit_note(as_in_file, thing.scale, others, source);
    if (!thing.is_mesh && !as_in_file.isEmpty()) {
      if (extent_of(as_in_file) == 0.0) note.reset();  // a half-space, for example
      // A floor or a wall may well be wide: an obstacle is too large only if its least side is.
      const Box3 least(Vector3::Zero(), Vector3::Constant(as_in_file.sizes().minCoeff()));
      if (thing.is_obstacle && !unit_note(least, thing.scale, others, source)) note.reset();
    }
    if (note) thing.warnings->add(thing.name, *note);
  }
}

void note_unused_springs(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies) {
  for (const BodyScene& body : scene.bodies) {
    if (!body.preset.empty()) continue;  // a material has springs for every shape
    const Body& built = built_body(network, body);
    const std::array<const std::optional<SpringMaterial>*, 3> materials{&body.springs.structural, &body.springs.shear,
                                                                        &body.springs.bend};
    for (const SpringKind kind : {SpringKind::structural, SpringKind::shear, SpringKind::bend}) {
      const auto index = static_cast<std::size_t>(kind);
      if (!*materials[index] || has_springs(network, built, kind)) continue;
      if (kind == SpringKind::bend && built.angle_bend_count + built.face_bend_count > 0) continue;
      bodies.add(body.name,
                 std::string("springs.") + kSpringKindNames[index] + " has no effect: its shape has no such springs. Remove it.");
    }
  }
}

void note_unusual_densities(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies) {
  constexpr double kFar = 100.0;
  const std::array<const char*, 3> units{" kg/m", " kg/m^2", " kg/m^3"};
  const std::array<const char*, 3> shapes{"ropes", "cloths", "solids"};
  for (const BodyScene& body : scene.bodies) {
    const Body& built = built_body(network, body);
    if (built.dimension == 0 || built.measure == 0.0) continue;
    // A rope with a mass per particle models masses on springs; it has no density.
    if (built.dimension == 1 && body.mass.kind == MassScene::Kind::particle) continue;
    const double density = own_mass(body.mass, built) / built.measure;
    const auto [least, largest] = range_of_densities(built.dimension);
    if (density >= least / kFar && density <= kFar * largest) continue;
    const auto kind = static_cast<std::size_t>(built.dimension) - 1;
    bodies.add(body.name, "its density is " + format_number(density, kDigits) + units.at(kind) + ", while that of materials for " +
                              shapes.at(kind) + " is " + format_number(least, kDigits) + " to " + format_number(largest, kDigits) +
                              units.at(kind) + ". Change its mass, or its size.");
  }
}

void note_mesh_faults(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies) {
  constexpr double kSamePlace = 1e-6;  // of the extent, as far as modelling programs round
  for (const BodyScene& body : scene.bodies) {
    const auto* mesh = std::get_if<MeshFile>(&body.shape);
    if (mesh == nullptr) continue;
    const Body& built = built_body(network, body);
    const Points positions = positions_of(network, built);
    const std::vector<Index> group_of = coincident_groups(positions, kSamePlace * extent_of(bounds(positions)));
    if (const Index repeated = count_repeated_faces(built.surface.faces, group_of); repeated > 0) {
      bodies.add(body.name,
                 counted(static_cast<std::size_t>(repeated), "face") + (repeated == 1 ? " lies" : " lie") +
                     " twice in its mesh, back to back or on the same side, so that it is heavier there, stiffer in its plane, and "
                     "without resistance to bending. "
                     "Delete the duplicates in the modelling program (Blender: Merge, By Distance), and export it again.");
    }
    if (!mesh->weld) continue;
    const std::vector<Index> open = vertices_on_border_edges(positions, built.surface.faces, *mesh->weld);
    if (open.empty()) continue;
    bodies.add(body.name,
               counted(open.size(), "vertex", "vertices") + (open.size() == 1 ? " lies" : " lie") +
                   " on an edge of another face that has no vertex there to weld, so that the seam stays open, first at " +
                   vector_text(positions.col(open.front()), kDigits) +
                   ". Add vertices to these edges in the modelling program, or cut both sides of the seam alike.");
  }
}

void note_thick_bodies(const SpringNetwork& network, GroupedWarnings& bodies) {
  for (const Body& body : network.bodies) {
    if (!body.contact.self) continue;
    const double edge = mean_edge(body.surface, positions_of(network, body));
    if (edge == 0.0 || body.material.thickness <= edge) continue;
    bodies.add(body.name, "thickness " + format_number(body.material.thickness, kDigits) +
                              " m is larger than its edges, which are " + format_number(edge, kDigits) +
                              " m long on average, so that each touches many others of the body and frames are slow. Use a smaller "
                              "thickness, longer edges, or \"self_contact\": false.");
  }
}

void note_wind_along_sheets(const Scene& scene, const SpringNetwork& network, GroupedWarnings& bodies) {
  const SimulatorSettings& settings = scene.settings;
  if (settings.wind.is_calm() || settings.wind.gusts()) return;
  for (const Body& body : network.bodies) {
    if (settings.air_surface.is_zero() && body.drag.is_zero()) continue;
    const auto normal = normal_of_sheet(network, body);
    if (!normal || has_moving_pin(network, body) || is_across(settings.gravity, *normal)) continue;
    const auto pushes = [&](const WindKeyframe& key) { return is_across(key.velocity, *normal); };
    if (std::ranges::any_of(settings.wind.keyframes(), pushes)) continue;
    bodies.add(
        body.name,
        "the wind blows exactly along its plane and has no gusts, so that it pushes the body to neither side and the body does not "
        "flutter. Turn the body or the wind by a degree, or add \"gusts\" to \"air\".");
  }
}

}  // namespace sprung
