#include "dynamics/integrators/schemes.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

namespace sprung {
namespace {

class ExplicitEuler final : public Integrator {
 public:
  explicit ExplicitEuler(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    evaluate(state, forces, dt, total_);
    record(total_, dt, state);
    for_free_particles(network(), [&](Index i) {
      state.x.col(i) += dt * state.v.col(i);
      state.v.col(i) += dt * network().inverse_masses[i] * total_.col(i);
    });
  }

 private:
  Points total_;
};

class SymplecticEuler final : public Integrator {
 public:
  explicit SymplecticEuler(const SpringNetwork& network) : Integrator(network) {}

  void advance(SimulationState& state, const Forces& forces, double dt) override {
    dampers().apply(state.x, dt, state);
    evaluate(state, forces, dt, total_);
    record(total_, dt, state);
    for_free_particles(network(), [&](Index i) { state.v.col(i) += dt * network().inverse_masses[i] * total_.col(i); });
    for_free_particles(network(), [&](Index i) { state.x.col(i) += dt * state.v.col(i); });
  }

 private:
  Points total_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_euler(const SpringNetwork& network) { return std::make_unique<ExplicitEuler>(network); }

std::unique_ptr<Integrator> make_symplectic_euler(const SpringNetwork& network) {
  return std::make_unique<SymplecticEuler>(network);
}

}  // namespace sprung
