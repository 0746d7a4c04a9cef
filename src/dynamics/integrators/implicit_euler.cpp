#include "dynamics/integrators/implicit_friction.h"
#include "dynamics/integrators/implicit_system.h"
#include "dynamics/integrators/schemes.h"

#include <optional>
#include <vector>

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
    friction_.assign(static_cast<std::size_t>(network().particle_count()), {});
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

  // One more Newton step on the scheme's own equations, M (v - v(t)) = dt F(x, v) + contact, from the positions that contact gave.
  // A response to first order alone would let contact stretch the springs far too much.
  bool respond_to_contact(const StepMotion& motion, const Forces& forces, const Points& from,
                          const ConstrainedDirections& constrained, SimulationState& state) override {
    v_ = motion.v_before;
    impulses_.resize(3, network().particle_count());
    for_free_particles(network(), [&](Index i) {
      add_push(motion, from, constrained, i, state);
      v_.col(i) = (state.x.col(i) - motion.before.col(i)) / motion.dt;
    });
    const Kinematics at{.x = state.x, .v = v_, .time = step_begin(state, motion.dt) + motion.dt};
    sum_forces(forces, at, gained_);
    differentiate(forces, at, derivatives_);
    system_->assemble(derivatives_, motion.dt);
    added_.resize(friction_.size());
    for_free_particles(network(), [&](Index i) {
      gained_.col(i) = motion.dt * gained_.col(i) + impulses_.col(i) - network().masses[i] * (v_.col(i) - motion.v_before.col(i));
      added_[static_cast<std::size_t>(i)] = constrain(constrained, i, motion.dt);
    });
    system_->solve(gained_);
    for_free_particles(network(), [&](Index i) { state.x.col(i) += motion.dt * gained_.col(i); });
    return update_friction(motion, constrained, state);
  }

 private:
  /// Computes the impulse that contact gives a particle apart from its constraints, and moves a particle that sticks back to where
  /// it has no slip.
  void add_push(const StepMotion& motion, const Points& from, const ConstrainedDirections& constrained, Index i,
                SimulationState& state) {
    const Vector3 push = state.x.col(i) - from.col(i);
    pushed_.col(i) += network().masses[i] / motion.dt * push;
    impulses_.col(i) = pushed_.col(i);
    if (constrained.supports(i).empty()) return;
    ImplicitFriction& friction = friction_[static_cast<std::size_t>(i)];
    const Vector3 slip = slip_of(motion, constrained, i, state);
    if (!friction.begun()) friction.begin(constrained.projection(i), push, slip, pushed_.col(i));
    impulses_.col(i) = friction.impulse();
    if (friction.sticks()) state.x.col(i) -= slip;
  }

  /// The motion of a particle in the step, relative to the surface that it touches and along it [m].
  [[nodiscard]] static Vector3 slip_of(const StepMotion& motion, const ConstrainedDirections& constrained, Index i,
                                       const SimulationState& state) {
    const Vector3 moved = state.x.col(i) - motion.before.col(i) - constrained.supports(i).front().displacement;
    return moved - constrained.projection(i) * moved;
  }

  Matrix3 constrain(const ConstrainedDirections& constrained, Index i, double dt) {
    const ImplicitFriction& friction = friction_[static_cast<std::size_t>(i)];
    if (constrained.supports(i).empty()) return system_->constrain(i, constrained.projection(i));
    if (friction.sticks()) return system_->constrain(i, Matrix3::Identity());
    if (friction.leaves()) return Matrix3::Zero();
    return system_->constrain(i, constrained.projection(i), dt * friction.stiffness());
  }

  /// Returns whether friction is not settled. Requires the solution of the linear system.
  [[nodiscard]] bool update_friction(const StepMotion& motion, const ConstrainedDirections& constrained,
                                     const SimulationState& state) {
    bool changed = false;
    for_free_particles(network(), [&](Index i) {
      if (constrained.supports(i).empty()) return;
      const Vector3 impulse = impulses_.col(i) - added_[static_cast<std::size_t>(i)] * gained_.col(i);
      const Vector3 slip = slip_of(motion, constrained, i, state);
      ImplicitFriction& friction = friction_[static_cast<std::size_t>(i)];
      if (friction.update(constrained.supports(i), constrained.projection(i), impulse, slip)) changed = true;
    });
    return changed;
  }

  ForceDerivatives derivatives_;
  std::optional<ImplicitSystem> system_;
  Points gained_;               // momentum, then velocity
  Points pushed_;               // impulses of the displacements by contact in this step [N s]
  Points impulses_;             // of contact, apart from its constraints [N s]
  std::vector<Matrix3> added_;  // to the matrix by contact
  std::vector<ImplicitFriction> friction_;
  Points v_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network) { return std::make_unique<ImplicitEuler>(network); }

}  // namespace sprung
