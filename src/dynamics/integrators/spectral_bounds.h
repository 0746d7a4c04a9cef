// Bounds on the fastest modes of a network.
#pragma once

#include "network/model/spring_network.h"

namespace sprung {

/// A damping below this fraction of critical does not outweigh the energy that resonance with the step feeds in. Measured: cloths
/// crumpled at three times their wave speed explode at half of it, and calm down at this value.
inline constexpr double kHardlyDamped = 0.01;

/// Bounds on the network's fastest modes: the largest eigenvalues of M^-1 L_k and M^-1 L_d, the scalar Laplacians weighted by
/// stiffness and damping, plus those of straight angle bends. Pinned particles are left out. The bounds hold in every
/// configuration in which no spring and no bond of an angle bend is compressed. Power iteration (Lanczos) from a fixed start
/// vector finds them. It converges from below, so the final residual (at most 1 %) and another 0.5 % are added.
struct SpectralBounds {
  double elastic = 0.0;   ///< l_K [1/s^2]
  double damping = 0.0;   ///< l_D [1/s]
  double undamped = 0.0;  ///< l_K of the springs that hardly damp the fastest mode [1/s^2]
  double penalty = 0.0;   ///< largest k_c / m of penalty contact [1/s^2]; included in `elastic`
  double drag = 0.0;      ///< largest c A / m of air drag [1/s]
  double damping_time =
      0.0;  ///< smallest k_d / k_s of springs and angle bends with stiffness [s]: a mode is damped by this times omega^2
  double least_drag = 0.0;  ///< smallest c A / m of air drag [1/s]
};

/// `drag` is that of AirDrag.
[[nodiscard]] SpectralBounds spectral_bounds(const SpringNetwork& network, double drag = 0.0);

}  // namespace sprung
