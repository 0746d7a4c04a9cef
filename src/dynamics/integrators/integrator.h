// Time integration: advances all free particles by one step. The caller moves pinned particles (inverse mass 0). Where a scheme
// evaluates forces within a step, pinned particles move on the straight line x + v t. If the state records impulses, a scheme adds
// those of the forces on pinned particles, with the weights that it gives them in a step.
#pragma once

#include "base/types.h"
#include "dynamics/forces/force.h"
#include "dynamics/integrators/damper_passes.h"
#include "dynamics/integrators/integrator_settings.h"

#include <memory>
#include <utility>

namespace sprung {

class ConstrainedDirections;
struct SimulationState;
struct SpringNetwork;
struct StepMotion;

class Integrator {
 public:
  /// Keeps a reference to the network.
  explicit Integrator(const SpringNetwork& network) : network_(network), dampers_(network) {}
  virtual ~Integrator() = default;

  /// Lets these dampers act at the begin of each step, in passes of their own; `rate` as in DamperPasses. They are not among
  /// the forces of `advance`. Requires a scheme that may_split_dampers().
  void set_dampers(Forces dampers, double rate) { dampers_.set(std::move(dampers), rate); }

  /// Prepares the scheme for the forces of all steps to come. Leaves a state that an integrator of the same scheme advanced as it
  /// is. Default: does nothing.
  virtual void resume(SimulationState& state, const Forces& forces, double dt);

  /// Initialises the data that the scheme keeps in the state between steps, and calls resume(). Call it once, before the first
  /// step.
  virtual void start(SimulationState& state, const Forces& forces, double dt);

  /// Advances x and v of free particles from t to t + dt. Members of an integrator are scratch memory: the result depends on the
  /// arguments alone.
  virtual void advance(SimulationState& state, const Forces& forces, double dt) = 0;

  /// Whether `respond_to_contact` does anything.
  [[nodiscard]] virtual bool responds_to_contact() const { return false; }

  /// Responds to contact, which moved some particles from `from` (the result of `advance` or of the last response) to state.x [m].
  /// A scheme that solves for the forces at the end of the step moves all particles to the new solution, except along their
  /// constrained directions, where contact balances any force. Supports add friction. Returns whether friction is not settled: a
  /// further call then changes it. Default: does nothing.
  virtual bool respond_to_contact(const StepMotion& motion, const Forces& forces, const Points& from,
                                  const ConstrainedDirections& constrained, SimulationState& state);

  /// Adds to state.impulses.of_contact the impulse [N s] of each free particle by which the responses to contact exceed the
  /// `pushes` of passes so far, 3 x n. Requires a state that records contact. Default: does nothing.
  virtual void record_contact(const StepMotion& motion, const Points& pushes, SimulationState& state) const;

  /// Computes the velocities after constraints moved the particles from `advanced` (the result of `advance`) to state.x; `before`
  /// are the positions at t. Default: v += (x - advanced) / dt. A scheme whose velocities depend on the forces at the end of the
  /// step evaluates them again. Unless `needs_advanced`, `advanced` is not read.
  virtual void recover_velocities(SimulationState& state, const Forces& forces, const Points& before, const Points& advanced,
                                  double dt);

  /// Called between two steps when the step length changes from `dt_before` to `dt` [s]. Verlet's velocity is that of half a step
  /// ago: it gains the acceleration times half the difference of the lengths.
  virtual void step_changed(SimulationState& state, const Forces& forces, double dt_before, double dt);

  /// Whether `advance` leaves the positions at t, including those of pinned particles, in state.x_previous. Default: no.
  [[nodiscard]] virtual bool keeps_positions() const { return false; }

  /// Whether `recover_velocities` reads `advanced`. Default: yes.
  [[nodiscard]] virtual bool needs_advanced() const { return true; }

  /// Called after contact changed the velocity of a particle. Verlet: x_previous = x - v dt.
  virtual void velocity_changed(SimulationState& state, Index particle, double dt) const;

 protected:
  [[nodiscard]] const SpringNetwork& network() const { return network_; }

  [[nodiscard]] DamperPasses& dampers() { return dampers_; }

  /// Adds `dt` [s] times the forces [N] on pinned particles to the impulses of the state, if it records them.
  void record(const Points& forces, double dt, SimulationState& state) const;

 private:
  const SpringNetwork& network_;
  DamperPasses dampers_;
};

/// Keeps a reference to the network.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings, const SpringNetwork& network);

}  // namespace sprung
