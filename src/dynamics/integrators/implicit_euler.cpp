#include "dynamics/integrators/implicit_system.h"
#include "dynamics/integrators/schemes.h"

#include <optional>

namespace sprung {
namespace {

class ImplicitEuler final : public Integrator {
 public:
  explicit ImplicitEuler(const SpringNetwork& network) : Integrator(network) {}

  void resume(SimulationState&, const Forces& forces, double) override {
    derivatives_ = make_derivatives(forces, network().particle_count());
    system_.emplace(network(), derivatives_);
  }

  // Pins do not change their velocity in the step, but their neighbours see their motion by h dF/dx v.
  void advance(SimulationState& state, const Forces& forces, double dt) override {
    pushed_.setZero(3, network().particle_count());
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

  [[nodiscard]] bool responds_to_contact() const override { return true; }

  // One more Newton step on the scheme's own equations, M (v - v(t)) = dt F(x, v), from the positions that contact gave. A
  // response to first order alone would let contact stretch the springs far too much.
  void respond_to_contact(const StepMotion& motion, const Forces& forces, const Points& from,
                          const ConstrainedDirections& constrained, SimulationState& state) override {
    v_ = motion.v_before;
    for_free_particles(network(), [&](Index i) {
      const Vector3 push = state.x.col(i) - from.col(i);
      pushed_.col(i) += network().masses[i] / motion.dt * push;
      v_.col(i) = (state.x.col(i) - motion.before.col(i)) / motion.dt;
    });
    const Kinematics at{.x = state.x, .v = v_, .time = step_begin(state, motion.dt) + motion.dt};
    sum_forces(forces, at, gained_);
    differentiate(forces, at, derivatives_);
    system_->assemble(derivatives_, motion.dt);
    for_free_particles(network(), [&](Index i) {
      gained_.col(i) = motion.dt * gained_.col(i) + pushed_.col(i) - network().masses[i] * (v_.col(i) - motion.v_before.col(i));
      system_->constrain(i, constrained.projection(i));
    });
    system_->solve(gained_);
    for_free_particles(network(), [&](Index i) { state.x.col(i) += motion.dt * gained_.col(i); });
  }

 private:
  ForceDerivatives derivatives_;
  std::optional<ImplicitSystem> system_;
  Points gained_;  // momentum, then velocity
  Points pushed_;  // impulses of contact in this step [N s], including friction
  Points v_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network) { return std::make_unique<ImplicitEuler>(network); }

}  // namespace sprung
