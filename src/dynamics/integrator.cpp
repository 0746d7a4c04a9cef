#include "dynamics/integrator.h"

#include "base/parallel.h"

#include <cmath>

namespace sprung {
namespace {

constexpr Index kParticleChunk = 8192;

/// Calls `body(i)` for each particle that is not pinned.
template <class Body>
void for_free_particles(const SpringNetwork& network, Body&& body) {
  parallel_chunks(network.particle_count(), kParticleChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (!network.is_pinned(i)) body(i);
    }
  });
}

void evaluate(const SimulationState& state, const Forces& forces, double dt, Points& total) {
  sum_forces(forces, {.x = state.x, .v = state.v, .time = static_cast<double>(state.step) * dt}, total);
}

class ExplicitEuler final : public Integrator {
 public:
  explicit ExplicitEuler(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt, Points& scratch) const override {
    evaluate(state, forces, dt, scratch);
    for_free_particles(network(), [&](Index i) {
      state.x.col(i) += dt * state.v.col(i);
      state.v.col(i) += dt * network().inverse_masses[i] * scratch.col(i);
    });
  }
};

class SymplecticEuler final : public Integrator {
 public:
  explicit SymplecticEuler(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt, Points& scratch) const override {
    evaluate(state, forces, dt, scratch);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += dt * network().inverse_masses[i] * scratch.col(i);
      state.x.col(i) += dt * state.v.col(i);
    });
  }
};

// Between steps state.v is (x - x_previous) / dt, so that forces and dampers of neighbours see Verlet's velocity without more ado.
class Verlet final : public Integrator {
 public:
  Verlet(const VerletSettings& settings, const SpringNetwork& network) : Integrator(network), settings_(settings) {}

  void start(SimulationState& state, const Forces& forces, double dt) const override {
    Integrator::start(state, forces, dt);
    if (settings_.start_at_rest) return;
    Points total;
    evaluate(state, forces, dt, total);
    for_free_particles(network(), [&](Index i) {
      state.x_previous.col(i) -= dt * state.v.col(i) - 0.5 * dt * dt * network().inverse_masses[i] * total.col(i);
    });
  }

  void advance(SimulationState& state, const Forces& forces, double dt, Points& scratch) const override {
    evaluate(state, forces, dt, scratch);
    const double kept = 1.0 - damping_per_step(settings_, dt);
    for_free_particles(network(), [&](Index i) {
      const Vector3 x = state.x.col(i);
      const Vector3 moved = kept * (x - state.x_previous.col(i)) + dt * dt * network().inverse_masses[i] * scratch.col(i);
      state.x_previous.col(i) = x;
      state.x.col(i) = x + moved;
      state.v.col(i) = (state.x.col(i) - x) / dt;
    });
  }

  void recover_velocities(SimulationState& state, const Points& before, const Points&, double dt) const override {
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) = (state.x.col(i) - before.col(i)) / dt;
      state.x_previous.col(i) = before.col(i);
    });
  }

  void velocity_changed(SimulationState& state, Index particle, double dt) const override {
    state.x_previous.col(particle) = state.x.col(particle) - dt * state.v.col(particle);
  }

 private:
  VerletSettings settings_;
};

struct MakeIntegrator {
  const SpringNetwork& network;

  std::unique_ptr<Integrator> operator()(const ExplicitEulerSettings&) const { return std::make_unique<ExplicitEuler>(network); }
  std::unique_ptr<Integrator> operator()(const SymplecticEulerSettings&) const {
    return std::make_unique<SymplecticEuler>(network);
  }
  std::unique_ptr<Integrator> operator()(const VerletSettings& verlet) const { return std::make_unique<Verlet>(verlet, network); }
};

}  // namespace

double damping_per_step(const VerletSettings& settings, double dt) {
  return settings.damping_rate > 0.0 ? -std::expm1(-settings.damping_rate * dt) : settings.damping;
}

void Integrator::start(SimulationState& state, const Forces&, double) const { state.x_previous = state.x; }

void Integrator::recover_velocities(SimulationState& state, const Points&, const Points& advanced, double dt) const {
  for_free_particles(network_, [&](Index i) { state.v.col(i) += (state.x.col(i) - advanced.col(i)) / dt; });
}

void Integrator::velocity_changed(SimulationState&, Index, double) const {}

std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings, const SpringNetwork& network) {
  return std::visit(MakeIntegrator{network}, settings);
}

}  // namespace sprung
