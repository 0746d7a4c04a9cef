// Time integration: advances all free particles by one step. Pinned particles (inverse mass 0) are left to the caller; where a
// scheme evaluates forces within a step, they go along the straight line x + v (time since its begin).
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/integrators/step_motion.h"
#include "network/spring_network.h"

#include <memory>
#include <variant>

namespace sprung {

/// Explicit Euler, exactly as eq. 1: p += v(t) dt with the old velocity, then v += F(t) / m dt.
struct ExplicitEulerSettings {};

/// Semi-implicit Euler, the manual's code: v += F / m dt, then p += v dt with the new velocity.
struct SymplecticEulerSettings {};

/// x(t + dt) = x + (1 - damping) (x - x(t - dt)) + a dt^2. Forces that need a velocity see (x - x(t - dt)) / dt, at the start v(0).
struct VerletSettings {
  double damping = 0.0;        ///< per step, in [0, 1], as printed
  double damping_rate = 0.0;   ///< [1/s]; when > 0 the damping per step is 1 - exp(-rate dt) instead
  bool start_at_rest = false;  ///< x(-dt) = x(0), as the web page, instead of x(0) - v(0) dt + a(0) dt^2 / 2
};

/// x(t + dt) = x + v dt + a(t) dt^2 / 2, v(t + dt) = v + (a(t) + a(t + dt)) dt / 2 (Swope et al. 1982), where a(t + dt) sees the
/// velocity v + a(t) dt: it is wrong by no more than dt^2, so that the scheme stays of second order with dampers and drag. Two
/// evaluations of the forces a step, and a third where a stretch limit or contact led anything elsewhere.
struct VelocityVerletSettings {};

/// The classic Runge-Kutta scheme of fourth order (Kutta 1901): four evaluations of the forces a step.
struct RungeKutta4Settings {};

/// v(t + dt) = v + dv, x(t + dt) = x + v(t + dt) dt with (M - dt dF/dv - dt^2 dF/dx) dv = dt (F + dt dF/dx v), where F is that of
/// the obstacles at t + dt (Baraff and Witkin 1998, one linear solve a step, one more for each answer to contact). Stable at any
/// step; its price is energy: a mode loses a factor of 1 + (omega dt)^2 a step.
struct ImplicitEulerSettings {};

/// The part of a step's movement that Verlet takes away, in [0, 1].
[[nodiscard]] double damping_per_step(const VerletSettings& settings, double dt);

using IntegratorSettings = std::variant<ExplicitEulerSettings, SymplecticEulerSettings, VerletSettings, VelocityVerletSettings,
                                        RungeKutta4Settings, ImplicitEulerSettings>;

class Integrator {
 public:
  /// Keeps a reference to the network.
  explicit Integrator(const SpringNetwork& network) : network_(network) {}
  virtual ~Integrator() = default;

  /// Sets what the scheme keeps between steps. Call once, before the first step, with the forces of all of them.
  virtual void start(SimulationState& state, const Forces& forces, double dt);

  /// Advances x and v of free particles from t to t + dt. What an integrator keeps for itself is room to calculate in: the result
  /// depends on the arguments alone.
  virtual void advance(SimulationState& state, const Forces& forces, double dt) = 0;

  /// Whether `answer_contact` does anything.
  [[nodiscard]] virtual bool answers_contact() const { return false; }

  /// Contact has pushed some particles from `from` (where `advance` or the last answer led them) to state.x [m]. A scheme that
  /// solves for the forces at the step's end leads all on to where these take them then, but none along what it is held along:
  /// what pushes it is as large as needed. Default: nothing.
  virtual void answer_contact(const StepMotion& motion, const Forces& forces, const Points& from, const ConstrainedDirections& held,
                              SimulationState& state);

  /// Velocities after constraints moved `advanced` (what `advance` made) to state.x; `before` are the positions at t. Default:
  /// v += (x - advanced) / dt. A scheme whose velocities hang on the forces where the step ends takes them there anew. Unless
  /// `needs_advanced`, `advanced` may be anything.
  virtual void recover_velocities(SimulationState& state, const Forces& forces, const Points& before, const Points& advanced,
                                  double dt);

  /// Steps that follow are this part, in (0, 1], of those that a damping per step is for. Default: there is none.
  virtual void set_part(double /*part*/) {}

  /// Called between two steps where steps of length `dt` follow those of length `dt_before` [s]. Verlet's velocity is that half a
  /// step ago: it gains what the forces give from then on to half a step of the new length ago.
  virtual void step_changed(SimulationState& state, const Forces& forces, double dt_before, double dt);

  /// Whether `advance` leaves the positions at t, of pinned particles too, in state.x_previous. Default: it does not.
  [[nodiscard]] virtual bool keeps_positions() const { return false; }

  /// Whether `recover_velocities` looks at `advanced`. Default: it does.
  [[nodiscard]] virtual bool needs_advanced() const { return true; }

  /// Called after contact changed velocities of a particle. Verlet: x_previous = x - v dt.
  virtual void velocity_changed(SimulationState& state, Index particle, double dt) const;

 protected:
  [[nodiscard]] const SpringNetwork& network() const { return network_; }

 private:
  const SpringNetwork& network_;
};

/// Keeps a reference to the network.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings, const SpringNetwork& network);

}  // namespace sprung
