// Small networks and obstacles that the tests of this folder share.
#pragma once

#include "dynamics/all_integrators.h"
#include "network/model/activity.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace sprung::testing {

inline constexpr double kGravity = 9.81;  // [m/s^2]

inline bool sleeps(const Simulator& simulator, std::size_t body) {
  return is_asleep(simulator.network(), simulator.network().bodies[body]);
}
/// Whether all bodies sleep.
inline bool sleeps(const Simulator& simulator) {
  return std::ranges::all_of(simulator.network().bodies, [&](const Body& body) { return is_asleep(simulator.network(), body); });
}

/// A particle of 0.1 kg on its own.
inline SpringNetwork one_particle(const Vector3& position, const ContactMaterial& material = {},
                                  const Vector3& velocity = Vector3::Zero()) {
  NetworkBuilder builder;
  builder.begin_body("ball", material);
  builder.add_particle(position, 0.1, velocity);
  return builder.build();
}

/// Solid below the plane through the origin, tilted by `angle` [rad] about z: it falls towards -x.
inline Obstacle ground(const ContactMaterial& material = {}, double angle = 0.0) {
  return {.name = "ground",
          .geometry = HalfSpaceGeometry{.normal = {-std::sin(angle), std::cos(angle), 0.0}, .offset = 0.0},
          .material = material};
}

/// An open mesh of two triangles: the square of half side `half` [m] around the origin in the plane y = 0.
inline Obstacle sheet(double half, const ContactMaterial& material = {}) {
  TriangleMesh mesh;
  mesh.vertices = half * (Points(3, 4) << -1, 1, 1, -1, 0, 0, 0, 0, -1, -1, 1, 1).finished();
  mesh.triangles = (Triangles(3, 2) << 0, 0, 2, 3, 1, 2).finished();
  return {.name = "sheet", .geometry = MeshGeometry{.mesh = std::make_shared<TriangleMesh>(mesh)}, .material = material};
}

/// A square of 2 x 2 m at height 0 that a linear map deforms in one second.
inline Obstacle deforming_sheet(const Matrix3& map) {
  MeshSequence sequence{.triangles = (Triangles(3, 2) << 0, 0, 2, 3, 1, 2).finished(), .frames = {}, .frame_rate = 1.0};
  const Points corners = (Points(3, 4) << -1, 1, 1, -1, 0, 0, 0, 0, -1, -1, 1, 1).finished();
  sequence.frames = {corners, map * corners};
  return {.name = "sheet", .geometry = SequenceGeometry{std::make_shared<const MeshSequence>(sequence), false}};
}

/// A cloth of 1 m and n x n particles, horizontal at `height` [m].
inline SpringNetwork cloth(Index n, double height, const ContactMaterial& material = {}) {
  BodyShape shape =
      make_cloth({.size = {1.0, 1.0}, .resolution = {n, n}}, {.structural = SpringMaterial{.value = 200.0, .damping = 0.01},
                                                              .shear = SpringMaterial{.value = 100.0, .damping = 0.01},
                                                              .bend = SpringMaterial{.value = 2.0}});
  set_total_mass(shape, 0.2);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({-90.0, 0.0, 0.0});
  pose.translation() = Vector3(0.0, height, 0.0);
  place(shape, pose, Vector3::Zero());
  NetworkBuilder builder;
  builder.add_body("cloth", shape, material);
  return builder.build();
}

/// A rod of one spring of 0.3 m.
inline NetworkBuilder rod() {
  NetworkBuilder builder;
  BodyShape shape = make_rope({.points = {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}}, .particles = 2, .length = {}},
                              {.structural = SpringMaterial{.value = 0.0}, .shear = {}, .bend = {}});
  set_total_mass(shape, 0.02);
  builder.add_body("rod", shape, {.thickness = 0.002});
  return builder;
}

/// A ball of radius 1 cm waits [s] and then rises in 0.1 s at 3 cm from the rod's first end, from 5 cm below it to 5 cm above it.
/// If both ends of the rod are pinned, no number of substeps makes the step feasible in which it meets the rod.
inline Obstacle rising_ball(double wait = 0.0) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.01}};
  ball.rest_pose.translation() = Vector3(0.03, -0.05, 0.0);
  ball.motion.keyframes = {{.time = wait}, {.time = wait + 0.1, .position = {0.0, 0.1, 0.0}}};
  return ball;
}

/// Of all bodies [kg m/s].
inline Vector3 momentum(const Simulator& simulator) { return simulator.state().v * simulator.network().masses; }

/// Of all bodies [kg].
inline double mass(const Simulator& simulator) { return simulator.network().masses.sum(); }

inline void run(Simulator& simulator, double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / simulator.settings().step));
  for (int i = 0; i < steps; ++i) simulator.step();
}

}  // namespace sprung::testing
