// Makers of the schemes, and what the schemes share. Each source file holds one family of schemes.
#pragma once

#include "base/parallel.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

namespace sprung {

/// Each keeps a reference to the network.
[[nodiscard]] std::unique_ptr<Integrator> make_explicit_euler(const SpringNetwork& network);
[[nodiscard]] std::unique_ptr<Integrator> make_symplectic_euler(const SpringNetwork& network);
[[nodiscard]] std::unique_ptr<Integrator> make_verlet(const VerletSettings& settings, const SpringNetwork& network);
[[nodiscard]] std::unique_ptr<Integrator> make_velocity_verlet(const SpringNetwork& network);
[[nodiscard]] std::unique_ptr<Integrator> make_runge_kutta4(const SpringNetwork& network);
[[nodiscard]] std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network);

/// Time [s] at the beginning of the step or substep of `dt` [s] that the state makes next.
[[nodiscard]] inline double step_begin(const SimulationState& state, double dt) {
  return steps_done(state) * (state.substeps * dt);
}

/// Writes the forces [N] at the beginning of the step, 3 x n, to `total`.
inline void evaluate(const SimulationState& state, const Forces& forces, double dt, Points& total) {
  sum_forces(forces, {.x = state.x, .v = state.v, .time = step_begin(state, dt)}, total);
}

/// Calls `body(i)` for each particle, including pinned ones, possibly in parallel.
template <class Body>
void for_particles(const SpringNetwork& network, Body&& body) {
  constexpr Index kParticleChunk = 8192;
  parallel_chunks(network.particle_count(), kParticleChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) body(i);
  });
}

/// Calls `body(i)` for each particle that is not pinned, possibly in parallel.
template <class Body>
void for_free_particles(const SpringNetwork& network, Body&& body) {
  for_particles(network, [&](Index i) {
    if (!network.is_fixed(i)) body(i);
  });
}

}  // namespace sprung
