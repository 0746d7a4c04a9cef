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
    system_->assemble(derivatives_, dt);
    system_->solve(gained_);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += gained_.col(i);
      state.x.col(i) += dt * state.v.col(i);
    });
  }

  [[nodiscard]] bool answers_contact() const override { return true; }

  // The equations are solved for what pushes change: those who were pushed move that far, as contact's own forces make them.
  void answer_contact(const Points& advanced, Points& positions, double dt) override {
    gained_.setZero(3, advanced.cols());
    for (Index i = 0; i < network().particle_count(); ++i) {
      if (!network().is_pinned(i)) system_->hold(i, (positions.col(i) - advanced.col(i)) / dt, gained_);
    }
    system_->solve(gained_);
    for_free_particles(network(), [&](Index i) { positions.col(i) = advanced.col(i) + dt * gained_.col(i); });
  }

 private:
  ForceDerivatives derivatives_;
  std::optional<ImplicitSystem> system_;
  Points gained_;  // momentum, then velocity
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network) { return std::make_unique<ImplicitEuler>(network); }

}  // namespace sprung
