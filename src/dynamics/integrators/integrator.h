// Time integration: advances all free particles by one step. The caller moves pinned particles (inverse mass 0). Where a scheme
// evaluates forces within a step, pinned particles move on the straight line x + v t. If the state records impulses, a scheme adds
// those of the forces on pinned particles, with the weights that it gives them in a step.
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/integrators/damper_passes.h"
#include "dynamics/integrators/step_motion.h"
#include "network/model/spring_network.h"

#include <memory>
#include <utility>
#include <variant>

namespace sprung {

/// Explicit Euler, exactly as eq. 1: p += v(t) dt with the old velocity, then v += F(t) / m dt.
struct ExplicitEulerSettings {};

/// Semi-implicit Euler, the manual's code: v += F / m dt, then p += v dt with the new velocity.
struct SymplecticEulerSettings {};

/// x(t + dt) = x + (1 - damping) (x - x(t - dt)) + a dt^2. Forces that need a velocity use (x - x(t - dt)) / dt, at the start
/// v(0).
struct VerletSettings {
  double damping = 0.0;        ///< per step, in [0, 1], as printed
  double damping_rate = 0.0;   ///< [1/s]; when > 0 the damping per step is 1 - exp(-rate dt) instead
  bool start_at_rest = false;  ///< x(-dt) = x(0), as on the web page, instead of x(0) - v(0) dt + a(0) dt^2 / 2
};

/// x(t + dt) = x + v dt + a(t) dt^2 / 2, v(t + dt) = v + (a(t) + a(t + dt)) dt / 2 (Swope et al. 1982). Here a(t + dt) is
/// evaluated at the velocity v + a(t) dt, whose error is of order dt^2, so that the scheme keeps second order with dampers and
/// drag. Evaluates the forces twice a step, and a third time after a stretch limit or contact moved a particle.
struct VelocityVerletSettings {};

/// The classic Runge-Kutta scheme of fourth order (Kutta 1901). Evaluates the forces four times a step.
struct RungeKutta4Settings {};

/// v(t + dt) = v + dv, x(t + dt) = x + v(t + dt) dt with (M - dt dF/dv - dt^2 dF/dx) dv = dt (F + dt dF/dx v), where F sees the
/// obstacles at t + dt (Baraff and Witkin 1998). Solves one linear system a step, and one more for each response to contact.
/// Stable at any step. It loses energy: a mode loses a factor of 1 + (omega dt)^2 a step.
struct ImplicitEulerSettings {};

/// The fraction of a step's movement that Verlet's damping removes, in [0, 1].
[[nodiscard]] double damping_per_step(const VerletSettings& settings, double dt);

using IntegratorSettings = std::variant<ExplicitEulerSettings, SymplecticEulerSettings, VerletSettings, VelocityVerletSettings,
                                        RungeKutta4Settings, ImplicitEulerSettings>;

class Integrator {
 public:
  /// Keeps a reference to the network.
  explicit Integrator(const SpringNetwork& network) : network_(network), dampers_(network) {}
  virtual ~Integrator() = default;

  /// Lets these dampers act at the end of each step, in shorter steps of their own; `rate` as in DamperPasses. They are not among
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
