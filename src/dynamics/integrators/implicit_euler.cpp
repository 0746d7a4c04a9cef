#include "base/sort_unique.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/integrators/implicit_friction.h"
#include "dynamics/integrators/implicit_system.h"
#include "dynamics/integrators/schemes.h"
#include "dynamics/integrators/step_motion.h"
#include "dynamics/state/simulation_state.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace sprung {
namespace {

/// The particles of a contact between elements, and which of them are on the first one: the same four can be the contact of a
/// vertex with a face and that of two edges.
using ElementKey = std::pair<decltype(ElementContact::particles), std::array<bool, ElementContact::kMostParticles>>;

ElementKey key_of(const ElementContact& contact) {
  ElementKey key{contact.particles, {}};
  for (std::size_t k = 0; k < contact.count; ++k) key.second[k] = contact.weights[k] > 0.0;
  return key;
}

class ImplicitEuler final : public Integrator {
 public:
  explicit ImplicitEuler(const SpringNetwork& network) : Integrator(network) {}

  void resume(SimulationState&, const Forces& forces, double) override {
    alone_.emplace(network(), forces, std::vector<ParticlePair>{});
    coupled_.reset();
  }

  // Pins do not change their velocity in the step, but their neighbours see their motion by h dF/dx v.
  void advance(SimulationState& state, const Forces& forces, double dt) override {
    pushed_.setZero(3, network().particle_count());
    friction_.assign(static_cast<std::size_t>(network().particle_count()), {});
    element_friction_.clear();
    const Kinematics at{.x = state.x, .v = state.v, .time = step_begin(state, dt) + dt};
    sum_forces(forces, at, gained_);
    differentiate(forces, at, alone_->derivatives);
    alone_->derivatives.by_position.add_product(state.v, dt, gained_);
    gained_ *= dt;
    alone_->system.assemble(alone_->derivatives, dt);
    if (records(state)) {
      recorded_.setZero(3, gained_.cols());
      constant_ = gained_;
    }
    alone_->system.solve(gained_);
    record_solution(alone_->derivatives, dt, state);
    for_free_particles(network(), [&](Index i) {
      state.v.col(i) += gained_.col(i);
      state.x.col(i) += dt * state.v.col(i);
    });
    solved_ = state.x;
    for (Index i = 0; i < network().particle_count(); ++i) {
      if (network().is_fixed(i)) solved_.col(i) += dt * state.v.col(i);
    }
    for (const auto& force : forces) force->note_solution(solved_);
  }

  [[nodiscard]] bool responds_to_contact() const override { return true; }

  // One more Newton step on the scheme's own equations, M (v - v(t)) = dt F(x, v) + contact, from the positions that contact gave.
  // A response to first order alone would let contact stretch the springs far too much.
  bool respond_to_contact(const StepMotion& motion, const Forces& forces, const Points& from,
                          const ConstrainedDirections& constrained, SimulationState& state) override {
    v_ = motion.v_before;
    impulses_.setZero(3, network().particle_count());
    for_free_particles(network(), [&](Index i) {
      add_push(motion, from, constrained, i, state);
      v_.col(i) = (state.x.col(i) - motion.before.col(i)) / motion.dt;
    });
    begin_element_friction(motion, constrained.element_contacts(), state);
    Linearization& linear = linearization_for(constrained.element_contacts(), forces);
    const Kinematics at{.x = state.x, .v = v_, .time = step_begin(state, motion.dt) + motion.dt};
    sum_forces(forces, at, gained_);
    differentiate(forces, at, linear.derivatives);
    linear.system.assemble(linear.derivatives, motion.dt);
    if (records(state)) constant_ = motion.dt * gained_;
    added_.resize(friction_.size());
    for_free_particles(network(), [&](Index i) {
      gained_.col(i) = motion.dt * gained_.col(i) + impulses_.col(i) - network().masses[i] * (v_.col(i) - motion.v_before.col(i));
      added_[static_cast<std::size_t>(i)] = constrain(linear.system, constrained, i, motion.dt);
    });
    constrain_elements(linear.system, constrained.element_contacts(), motion.dt);
    linear.system.solve(gained_);
    record_solution(linear.derivatives, motion.dt, state);
    for_free_particles(network(), [&](Index i) { state.x.col(i) += motion.dt * gained_.col(i); });
    for (const auto& force : forces) force->note_solution(state.x);
    const bool changed = update_friction(motion, constrained, state);
    return update_element_friction(motion, constrained.element_contacts(), state) || changed;
  }

  // Contact gives what the balance of momentum lacks, M (v - v(t)) - dt F.
  void record_contact(const StepMotion& motion, const Points& pushes, SimulationState& state) const override {
    for_free_particles(network(), [&](Index i) {
      if (pushed_.col(i).isZero(0.0) && pushes.col(i).isZero(0.0)) return;
      const Vector3 velocity = (state.x.col(i) - motion.before.col(i)) / motion.dt;
      const Vector3 impulse = network().masses[i] * (velocity - motion.v_before.col(i)) - constant_.col(i);
      state.impulses.of_contact.col(i) += impulse - pushes.col(i);
    });
  }

 private:
  [[nodiscard]] static bool records(const SimulationState& state) { return state.impulses.on() || state.impulses.has_contact(); }

  /// Records the impulses of the linearised forces, in place of those of an earlier solve in the step. Requires the solution, and
  /// its impulses without the change of the velocities in `constant_`.
  void record_solution(const ForceDerivatives& derivatives, double dt, SimulationState& state) {
    if (!records(state)) return;
    derivatives.by_velocity.add_product(gained_, dt, constant_);
    derivatives.by_position.add_product(gained_, dt * dt, constant_);
    record(recorded_, -1.0, state);
    record(constant_, 1.0, state);
    recorded_ = constant_;
  }

  /// The linear system with the pattern of all forces and of further pairs, ascending.
  struct Linearization {
    Linearization(const SpringNetwork& network, const Forces& forces, std::vector<ParticlePair> further)
        : pairs(std::move(further)),
          derivatives(make_derivatives(forces, network.particle_count(), pairs)),
          system(network, derivatives) {}

    std::vector<ParticlePair> pairs;
    ForceDerivatives derivatives;
    ImplicitSystem system;
  };

  /// A contact between elements in one linear solve.
  struct ElementSolve {
    ImplicitFriction* friction = nullptr;
    Vector3 back = Vector3::Zero();   ///< by which the solve moves the sum, because it sticks [m]
    Matrix3 added = Matrix3::Zero();  ///< to the equations of the sum
  };

  /// The pattern depends on the contacts of the moment alone, so that a resumed run has the same bits.
  Linearization& linearization_for(const std::vector<ElementContact>& contacts, const Forces& forces) {
    if (contacts.empty()) return *alone_;
    std::vector<ParticlePair> pairs;
    for (const ElementContact& contact : contacts) {
      for (std::size_t k = 0; k < contact.count; ++k) {
        for (std::size_t l = 0; l < k; ++l) {
          const auto [first, second] = std::minmax(contact.particles[k], contact.particles[l]);
          pairs.push_back({first, second});
        }
      }
    }
    sort_unique(pairs);
    if (!coupled_ || coupled_->pairs != pairs) coupled_.emplace(network(), forces, std::move(pairs));
    return *coupled_;
  }

  /// Computes the impulse that contact gives a particle apart from its constraints, and moves a particle that sticks back to where
  /// it has no slip.
  void add_push(const StepMotion& motion, const Points& from, const ConstrainedDirections& constrained, Index i,
                SimulationState& state) {
    const Vector3 push = state.x.col(i) - from.col(i);
    pushed_.col(i) += network().masses[i] / motion.dt * push;
    if (constrained.supports(i).empty()) {
      const bool is_truncated = !constrained.projection(i).isZero(0.0);
      if (is_truncated) impulses_.col(i) = pushed_.col(i);
      return;
    }
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

  Matrix3 constrain(ImplicitSystem& system, const ConstrainedDirections& constrained, Index i, double dt) {
    const ImplicitFriction& friction = friction_[static_cast<std::size_t>(i)];
    if (constrained.supports(i).empty()) return system.constrain(i, constrained.projection(i));
    if (friction.sticks()) return system.constrain(i, Matrix3::Identity());
    if (friction.leaves()) return Matrix3::Zero();
    return system.constrain(i, constrained.projection(i), dt * friction.stiffness());
  }

  /// Adds the friction of contacts between elements to the impulses.
  void begin_element_friction(const StepMotion& motion, const std::vector<ElementContact>& contacts, const SimulationState& state) {
    element_solves_.assign(contacts.size(), {});
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const ElementContact& contact = contacts[c];
      const Vector3 slip = slip_of(motion, contact, state);
      ImplicitFriction& friction = element_friction_[key_of(contact)];
      if (!friction.begun()) friction.begin(along(contact), contact.push, slip, contact.mass / motion.dt * contact.push);
      const Vector3& impulse = friction.impulse();
      for (std::size_t k = 0; k < contact.count; ++k) impulses_.col(contact.particles[k]) += contact.weights[k] * impulse;
      element_solves_[c] = {.friction = &friction, .back = friction.sticks() ? Vector3(-slip) : Vector3::Zero()};
    }
  }

  /// Two elements that stick move back together in the solve, which knows what holds them.
  void constrain_elements(ImplicitSystem& system, const std::vector<ElementContact>& contacts, double dt) {
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const ElementContact& contact = contacts[c];
      ElementSolve& solve = element_solves_[c];
      if (solve.friction->leaves()) continue;
      solve.added = solve.friction->sticks() ? system.constrain(contact, Matrix3::Identity(), Matrix3::Zero())
                                             : system.constrain(contact, along(contact), dt * solve.friction->stiffness());
      for (std::size_t k = 0; k < contact.count; ++k) {
        gained_.col(contact.particles[k]) += contact.weights[k] / dt * (solve.added * solve.back);
      }
    }
  }

  /// Returns whether friction between elements is not settled. Requires the solution of the linear system.
  [[nodiscard]] bool update_element_friction(const StepMotion& motion, const std::vector<ElementContact>& contacts,
                                             const SimulationState& state) {
    bool changed = false;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const ElementContact& contact = contacts[c];
      const ElementSolve& solve = element_solves_[c];
      const Vector3 impulse = solve.friction->impulse() - solve.added * (contact.sum(gained_) - solve.back / motion.dt);
      const Vector3 slip = slip_of(motion, contact, state);
      if (solve.friction->update({&contact.support, 1}, along(contact), impulse, slip)) changed = true;
    }
    return changed;
  }

  [[nodiscard]] static Matrix3 along(const ElementContact& contact) {
    return contact.support.normal * contact.support.normal.transpose();
  }

  /// The motion of two elements along each other in the step [m].
  [[nodiscard]] static Vector3 slip_of(const StepMotion& motion, const ElementContact& contact, const SimulationState& state) {
    const Vector3 moved = contact.sum(state.x) - contact.sum(motion.before);
    return moved - along(contact) * moved;
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

  std::optional<Linearization> alone_;    // of the forces
  std::optional<Linearization> coupled_;  // of the forces and of the last contacts between elements
  Points gained_;                         // momentum, then velocity
  Points solved_;                         // positions that solve the linear system, pins moved along
  Points pushed_;                         // impulses of the displacements by contact in this step [N s]
  Points impulses_;                       // of contact, apart from its constraints [N s]
  std::vector<Matrix3> added_;            // to the matrix by contact
  std::vector<ImplicitFriction> friction_;
  std::map<ElementKey, ImplicitFriction> element_friction_;
  std::vector<ElementSolve> element_solves_;
  Points v_;
  Points constant_;  // impulses of the linearised forces [N s]; see record_solution
  Points recorded_;  // those of the last solve of the step
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler(const SpringNetwork& network) { return std::make_unique<ImplicitEuler>(network); }

}  // namespace sprung
