// How fast the fastest modes of a network are.
#pragma once

#include "network/spring_network.h"

namespace sprung {

/// What damps by less than this part of critical does not outweigh the energy that resonance of the fastest motion with the step
/// gives: cloths crumpled at three times the speed of their waves explode with half of it, and calm down with this.
inline constexpr double kHardlyDamped = 0.01;

/// Bounds on the network's fastest modes, from the largest eigenvalues of M^-1 L_k and M^-1 L_d, the scalar Laplacians weighted
/// by stiffness and damping, plus those of angle bends in line; pinned particles are left out. They bound every configuration of
/// springs, and of angle bends between bonds, that are not compressed.
/// Found by power iteration (Lanczos) from a fixed start vector, which converges from below: the residual it ends with, at most
/// 1 %, is added, and half a per cent more.
struct SpectralBounds {
  double elastic = 0.0;       ///< l_K [1/s^2]
  double damping = 0.0;       ///< l_D [1/s]
  double undamped = 0.0;      ///< l_K of those alone that damp the fastest motion hardly [1/s^2]
  double penalty = 0.0;       ///< largest k_c / m of penalty contact [1/s^2]: what `elastic` has of it
  double drag = 0.0;          ///< largest c A / m of air drag [1/s]
  double damping_time = 0.0;  ///< least k_d / k_s of springs and angle bends with stiffness [s]: damps modes by this omega^2
  double least_drag = 0.0;    ///< least c A / m of air drag [1/s]
};

/// `drag` as AirDrag's.
[[nodiscard]] SpectralBounds spectral_bounds(const SpringNetwork& network, double drag = 0.0);

}  // namespace sprung
