// The integration schemes and their settings.
#pragma once

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

}  // namespace sprung
