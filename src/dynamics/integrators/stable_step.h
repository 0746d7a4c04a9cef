// The largest step at which an explicit scheme does not blow up.
#pragma once

#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/spectral_bounds.h"

namespace sprung {

/// Symplectic Euler: dt^2 l_K + 2 dt l_D < 4. Verlet: the same with 4 - 2 d, d the damping per step. Drag counts as damping.
/// Velocity Verlet: dt^2 l_K + 2 dt l_D - dt^2 l_D^2 < 4 while dt l_D <= 1, then dt^2 l_K < 3 and dt l_D < 2. RK4: dt sqrt(l_K) <=
/// 2.828 while dt l_D <= 1.7, then 2.615; and dt l_D <= 2.785. Explicit Euler: the smaller of 2 / omega and 2 / l_D; below it modes
/// may still grow, if slowly: see growth_time. Infinity for implicit Euler, and without springs and drag.
[[nodiscard]] double largest_stable_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Where forces are not linear, as those of crumpled springs, leapfrog schemes (symplectic Euler, Verlet, velocity Verlet) feed
/// energy into motion of which three, four, five or six steps are a turn, the more the fewer: below their largest stable step
/// things explode all the same (Skeel, Zhang and Schlick 1997). This is the step of which six are a turn, 1 / omega, of the fastest
/// motion that springs and drag hardly damp. What is left is what springs gain that pass through having no length, where their
/// force turns about at once: ever less with smaller steps, never nothing. Infinity when nothing is hardly damped, for other
/// schemes, and for a Verlet whose own damping is enough.
[[nodiscard]] double resonant_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Explicit Euler has no stable step for an undamped mode: its fastest grows by e within 2 / (omega^2 dt) [s], or 2 / (omega^2 dt -
/// c) with damping c [1/s]. Infinity when damping outweighs the gain, dt < c / omega^2, and for other schemes. Springs damp along
/// themselves only: sideways swings of taut springs grow all the same, if slower.
[[nodiscard]] double growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double step);

/// The largest step at which growth_time is at least `time` [s]; infinity for schemes that do not gain energy, and without springs.
[[nodiscard]] double step_for_growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double time);

}  // namespace sprung
