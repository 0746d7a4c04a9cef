// The largest step at which an explicit scheme does not blow up.
#pragma once

#include "dynamics/integrator.h"

namespace sprung {

/// Bounds on the network's fastest modes, from the largest eigenvalues of M^-1 L_k and M^-1 L_d, the scalar Laplacians weighted
/// by stiffness and damping, plus those of angle bends in line; pinned particles are left out. They bound every configuration of
/// springs, and of angle bends between bonds, that are not compressed.
/// Found by power iteration (Lanczos) from a fixed start vector, which converges from below: the residual it ends with, at most
/// 1 %, is added, and half a per cent more.
struct SpectralBounds {
  double elastic = 0.0;       ///< l_K [1/s^2]
  double damping = 0.0;       ///< l_D [1/s]
  double drag = 0.0;          ///< largest c A / m of air drag [1/s]
  double damping_time = 0.0;  ///< least k_d / k_s of springs and angle bends with stiffness [s]: damps modes by this omega^2
  double least_drag = 0.0;    ///< least c A / m of air drag [1/s]
};

/// `drag` as AirDrag's.
[[nodiscard]] SpectralBounds spectral_bounds(const SpringNetwork& network, double drag = 0.0);

/// Symplectic Euler: dt^2 l_K + 2 dt l_D < 4. Verlet: the same with 4 - 2 d, d the damping per step. Drag counts as damping.
/// Velocity Verlet: dt^2 l_K + 2 dt l_D - dt^2 l_D^2 < 4 while dt l_D <= 1, then dt^2 l_K < 3 and dt l_D < 2. RK4: dt sqrt(l_K) <=
/// 2.828 while dt l_D <= 1.7, then 2.615; and dt l_D <= 2.785. Explicit Euler: the smaller of 2 / omega and 2 / l_D; below it modes
/// may still grow, if slowly: see growth_time. Infinity for implicit Euler, and without springs and drag.
[[nodiscard]] double largest_stable_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Explicit Euler has no stable step for an undamped mode: its fastest grows by e within 2 / (omega^2 dt) [s], or 2 / (omega^2 dt -
/// c) with damping c [1/s]. Infinity when damping outweighs the gain, dt < c / omega^2, and for other schemes. Springs damp along
/// themselves only: sideways swings of taut springs grow all the same, if slower.
[[nodiscard]] double growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double step);

/// The largest step at which growth_time is at least `time` [s]; infinity for schemes that do not gain energy, and without springs.
[[nodiscard]] double step_for_growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double time);

}  // namespace sprung
