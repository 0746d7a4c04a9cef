// The largest stable step of explicit schemes.
#pragma once

#include "dynamics/integrators/integrator_settings.h"
#include "dynamics/integrators/spectral_bounds.h"

namespace sprung {

/// The largest stable step [s]. Symplectic Euler: dt^2 l_K + 2 dt l_D < 4. Verlet: the same with 4 - 2 d, d the damping per step.
/// Velocity Verlet: dt^2 l_K + 2 dt l_D - dt^2 l_D^2 < 4 while dt l_D <= 1, then dt^2 l_K < 3 and dt l_D <
/// 2. RK4: dt sqrt(l_K) <= 2.828 while dt l_D <= 1.7, then 2.615; and dt l_D <= 2.785. Explicit Euler: the smaller of 2 / omega
/// and 2 / l_D; below it modes may still grow slowly, see growth_time. Infinity for implicit Euler, and without springs and drag.
/// Here l_D leaves out the dampers of materials (DamperPasses), except for explicit Euler.
[[nodiscard]] double largest_stable_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Whether the scheme may integrate the dampers of materials apart from the other forces. Explicit Euler stays as printed, and
/// implicit Euler is stable with them.
[[nodiscard]] bool may_split_dampers(const IntegratorSettings& settings);

/// The bounds of a simulation that takes the dampers of materials like all others.
[[nodiscard]] SpectralBounds with_all_dampers(const SpectralBounds& bounds);

/// The largest step without resonance [s]. Where forces are not linear, as in crumpled springs, leapfrog schemes (symplectic
/// Euler, Verlet, velocity Verlet) feed energy into motions whose period is three to six steps, the more the fewer the steps. A
/// simulation can then explode below the largest stable step (Skeel, Zhang and Schlick 1997). The result gives six steps per
/// period, 1 / omega, to the fastest motion that springs and drag hardly damp. Springs that pass through zero length still gain
/// some energy, because their force reverses at once; a smaller step reduces this gain but does not end it. Infinity if everything
/// is damped enough, and for other schemes.
[[nodiscard]] double resonant_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// The time [s] in which explicit Euler multiplies the fastest mode by e. Explicit Euler has no stable step for an undamped mode:
/// 2 / (omega^2 dt), or 2 / (omega^2 dt - c) with damping c [1/s]. Infinity where damping outweighs the gain, dt < c / omega^2,
/// and for other schemes. Springs damp along themselves only, so sideways vibration of taut springs still grows, more slowly.
[[nodiscard]] double growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double step);

/// The largest step [s] at which growth_time is at least `time` [s]; infinity for schemes that gain no energy, and without
/// springs.
[[nodiscard]] double step_for_growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double time);

}  // namespace sprung
