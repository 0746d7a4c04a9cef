// The largest step at which an explicit scheme does not blow up.
#pragma once

#include "dynamics/integrator.h"

namespace sprung {

/// Bounds on the network's fastest modes, from the largest eigenvalues of M^-1 L_k and M^-1 L_d, the scalar Laplacians weighted
/// by stiffness and damping. They bound every configuration. Power iteration converges from below, so a margin is added.
struct SpectralBounds {
  double elastic = 0.0;  ///< l_K [1/s^2]
  double damping = 0.0;  ///< l_D [1/s]
  double drag = 0.0;     ///< largest c A / m [1/s]
};
[[nodiscard]] SpectralBounds spectral_bounds(const SpringNetwork& network, double drag = 0.0);

/// Symplectic Euler and Verlet: dt^2 l_K + 2 dt l_D < 4. Explicit Euler: 2 / omega, or what damping allows.
[[nodiscard]] double largest_stable_step(const IntegratorSettings& settings, const SpectralBounds& bounds);

/// Explicit Euler has no stable step for an undamped mode: its fastest grows by e within 2 / (omega^2 dt) [s]. Infinity for other
/// schemes.
[[nodiscard]] double growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double step);

}  // namespace sprung
