#include "dynamics/integration_schemes.h"

#include <cmath>

namespace sprung {
namespace {

// Between steps state.v is (x - x_previous) / dt, so that forces and dampers of neighbours see Verlet's velocity without more ado.
class Verlet final : public Integrator {
 public:
  Verlet(const VerletSettings& settings, const SpringNetwork& network) : Integrator(network), settings_(settings) {}

  void start(SimulationState& state, const Forces& forces, double dt) override {
    Integrator::start(state, forces, dt);
    if (settings_.start_at_rest) return;
    evaluate(state, forces, dt, total_);
    for_free_particles(network(), [&](Index i) {
      state.x_previous.col(i) -= dt * state.v.col(i) - 0.5 * dt * dt * network().inverse_masses[i] * total_.col(i);
    });
  }

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    evaluate(state, forces, dt, total_);
    const double kept = 1.0 - damping_per_step(settings_, dt);
    for_free_particles(network(), [&](Index i) {
      const Vector3 x = state.x.col(i);
      const Vector3 moved = kept * (x - state.x_previous.col(i)) + dt * dt * network().inverse_masses[i] * total_.col(i);
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
  Points total_;
};

// The acceleration at the step's end is not kept for the next one: dampers, constraints and contact change what it depends on.
class VelocityVerlet final : public Integrator {
 public:
  explicit VelocityVerlet(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    evaluate(state, forces, dt, total_);
    x_ = state.x;
    v_ = state.v;
    for_particles(network(), [&](Index i) {
      const Vector3 gained = dt * network().inverse_masses[i] * total_.col(i);
      x_.col(i) += dt * (v_.col(i) + 0.5 * gained);
      v_.col(i) += gained;
    });
    sum_forces(forces, {.x = x_, .v = v_, .time = step_begin(state, dt) + dt}, total_);
    for_free_particles(network(), [&](Index i) {
      state.x.col(i) = x_.col(i);
      state.v.col(i) = 0.5 * (state.v.col(i) + v_.col(i) + dt * network().inverse_masses[i] * total_.col(i));
    });
  }

 private:
  Points x_;  // at the step's end, and what velocities would be there if forces did not change
  Points v_;
  Points total_;
};

}  // namespace

double damping_per_step(const VerletSettings& settings, double dt) {
  return settings.damping_rate > 0.0 ? -std::expm1(-settings.damping_rate * dt) : settings.damping;
}

std::unique_ptr<Integrator> make_verlet(const VerletSettings& settings, const SpringNetwork& network) {
  return std::make_unique<Verlet>(settings, network);
}

std::unique_ptr<Integrator> make_velocity_verlet(const SpringNetwork& network) { return std::make_unique<VelocityVerlet>(network); }

}  // namespace sprung
