#include "viewer/live/shown_simulator.h"

#include "output/scene_extent.h"
#include "simulation/diagnostics.h"
#include "simulation/model.h"

#include <array>
#include <utility>
#include <variant>

namespace sprung {

Topology topology_of(const Simulator& simulator) {
  const SpringNetwork& network = simulator.network();
  Topology topology;
  topology.particles = network.particle_count();
  for (const Body& body : network.bodies) {
    append_columns(body.surface.triangles, body.first_particle, topology.triangles);
    append_columns(body.surface.segments, body.first_particle, topology.segments);
  }
  const Springs& springs = network.springs;
  topology.springs.resize(2, springs.count());
  for (Index s = 0; s < springs.count(); ++s) {
    topology.springs.col(s) << springs.first[s], springs.second[s];
    topology.rest_lengths.push_back(static_cast<float>(springs.rest_length[s]));
    topology.kinds.push_back(static_cast<std::uint32_t>(springs.kind[s]));
  }
  const Box3 scene = scene_bounds(simulator);
  for (const Obstacle& obstacle : simulator.obstacles()) {
    TriangleMesh mesh = surface_mesh(obstacle, scene);
    if (!obstacle.changes()) mesh.vertices = obstacle.rest_pose * mesh.vertices;
    topology.obstacles.push_back(std::move(mesh));
  }
  return topology;
}

FrameState state_of(const Simulator& simulator) {
  const SpringNetwork& network = simulator.network();
  FrameState state;
  state.positions = simulator.positions();
  state.speeds = simulator.state().v.colwise().norm().transpose();
  state.states.assign(static_cast<std::size_t>(network.particle_count()), 0);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.activity.is_pinned(i)) state.states[static_cast<std::size_t>(i)] |= kPinned;
  }
  for (const Index i : simulator.contact_particles()) state.states[static_cast<std::size_t>(i)] |= kInContact;
  if (simulator.settings().record_contact_forces) {
    state.contact_forces = simulator.contact_forces();
    for (Index i = 0; i < network.particle_count(); ++i) {
      if (!state.contact_forces.col(i).isZero(0.0)) state.states[static_cast<std::size_t>(i)] |= kHasForce;
    }
  }
  for (const Obstacle& obstacle : simulator.obstacles()) {
    if (!obstacle.changes()) continue;
    const RigidTransform pose = obstacle.motion.pose(obstacle.rest_pose, simulator.time());
    if (obstacle.deforms()) {
      state.deformed.push_back(pose * obstacle_mesh(obstacle.geometry, 0.0, simulator.time()).vertices);
    } else {
      state.poses.push_back(pose);
    }
  }
  return state;
}

std::string integrator_name(const Simulator& simulator) {
  constexpr std::array<const char*, std::variant_size_v<IntegratorSettings>> kNames{
      "explicit_euler", "symplectic_euler", "verlet", "velocity_verlet", "rk4", "implicit_euler"};
  return kNames[simulator.settings().integrator.index()];
}

FrameNumbers numbers_of(const Simulator& simulator) {
  return {.kinetic = kinetic_energy(simulator),
          .elastic = simulator.elastic_energy(),
          .gravity = simulator.gravity_energy(),
          .max_stretch = max_stretch(simulator),
          .contacts = simulator.contact_count(),
          .contact_energy = simulator.contact_energy()};
}

}  // namespace sprung
