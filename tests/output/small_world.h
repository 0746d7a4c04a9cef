// A world with one of each: what a run has to write.
#pragma once

#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <string>
#include <utility>

namespace sprung::testing {

inline const SpringMaterials kSoft{SpringMaterial{.value = 10.0}, {}, {}};

inline Obstacle still(const std::string& name, ObstacleGeometry geometry, const Vector3& position) {
  Obstacle obstacle;
  obstacle.name = name;
  obstacle.geometry = std::move(geometry);
  obstacle.rest_pose.translation() = position;
  return obstacle;
}

inline Obstacle rising(const std::string& name, ObstacleGeometry geometry, const Vector3& position) {
  Obstacle obstacle = still(name, std::move(geometry), position);
  obstacle.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, 0.25, 0.0}}};
  return obstacle;
}

inline PolygonMesh quad_with_uvs() {
  PolygonMesh mesh;
  mesh.vertices.resize(3, 5);
  mesh.vertices << 0, 1, 1, 0, 0.5, 0, 0, 1, 1, 2, 0, 0, 0, 0, 0;
  mesh.faces.corner_begin = {0, 4, 7};
  mesh.faces.vertex = {0, 1, 2, 3, 3, 2, 4};
  mesh.faces.texcoord = {0, 1, 2, 3, 3, 2, 4};
  mesh.faces.texcoords = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.5, 0.1}};
  mesh.faces.groups = {"wall", "roof"};
  mesh.faces.group_begin = {0, 1};
  return mesh;
}

/// A rope, a cloth and a mesh body that fall, a ball that rests, a box that rises, and a floor.
inline Simulator small_world() {
  NetworkBuilder builder;
  const auto add = [&](const std::string& name, BodyShape shape, const Vector3& position) {
    set_total_mass(shape, 1.0);
    RigidTransform pose = RigidTransform::Identity();
    pose.translation() = position;
    place(shape, pose);
    builder.add_body(name, shape);
  };
  add("rope", make_rope({{{0.0, 1.0 / 3.0, 0.0}, {1.0, 1.0, 0.1}}, 4, {}}, kSoft), {0.0, 2.0, 0.0});
  add("cloth", make_cloth({.size = {1.0, 0.7}, .resolution = {3, 4}}, kSoft), {3.0, 2.0, 0.0});
  add("house", make_mesh_body(quad_with_uvs(), kSoft), {6.0, 2.0, 0.0});
  SimulatorSettings settings;
  settings.step = 0.01;
  settings.steps_per_frame = 2;
  return Simulator(
      builder.build(), settings,
      {still("ball", SphereGeometry{0.2}, {0.0, 0.3, 5.0}), rising("lift", BoxGeometry{{0.2, 0.2, 0.2}}, {3.0, 0.5, 5.0}),
       still("floor", HalfSpaceGeometry{}, Vector3::Zero())});
}

}  // namespace sprung::testing
