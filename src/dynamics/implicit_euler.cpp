#include "dynamics/implicit_system.h"
#include "dynamics/integration_schemes.h"

#include <optional>

namespace sprung {
namespace {

class ImplicitEuler final : public Integrator {
 public:
  explicit ImplicitEuler(const SpringNetwork& network) : Integrator(network) {}

  void start(SimulationState& state, const Forces& forces, double dt) override {
    Integrator::start(state, forces, dt);
    derivatives_ = make_derivatives(forces, network().particle_count());
    system_.emplace(network(), derivatives_);
  }

  // Pins do not change their velocity in the step, but by h dF/dx v their neighbours know where they go.
  void advance(SimulationState& state, const Forces& forces, double dt) override {
    const Kinematics at{.x = state.x, .v = state.v, .time = step_begin(state, dt) + dt};
    sum_forces(forces, at, gained_);
    differentiate(forces, at, derivatives_);
    derivatives_.by_position.add_product(state.v, dt, gained_);
    gained_ *= dt;
    system_->solve(derivatives_, dt, gained_);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += gained_.col(i);
      state.x.col(i) += dt * state.v.col(i);
    });
  }

 private:
  ForceDerivatives derivatives_;
  std::optional<ImplicitSystem> system_;
  Points gained_;  // momentum, then velocity
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network) { return std::make_unique<ImplicitEuler>(network); }

}  // namespace sprung
