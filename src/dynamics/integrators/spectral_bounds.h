// Bounds on the fastest modes of a network.
#pragma once

#include "base/types.h"

#include <string>
#include <vector>

namespace sprung {

struct LinearElement;

/// A damping below this fraction of critical does not outweigh the energy that resonance with the step feeds in. Measured: cloths
/// crumpled at three times their wave speed explode at half of it, and calm down at this value.
inline constexpr double kHardlyDamped = 0.01;

/// Bounds on the fastest modes of all forces together: the largest eigenvalues of M^-1 K and M^-1 C, the sums of the matrices of
/// their elements. Pinned particles are left out. The bounds hold in every configuration in which no spring and no bond of an angle
/// bend is compressed. Power iteration (Lanczos) from a fixed start vector finds them. It converges from below, so the final
/// residual (at most 1 %) and another 0.5 % are added.
struct SpectralBounds {
  double elastic = 0.0;           ///< l_K [1/s^2]
  double damping = 0.0;           ///< l_D of all dampers but those of materials, with drag [1/s]
  double material_damping = 0.0;  ///< l_D of the dampers of materials alone [1/s]
  double all_damping = 0.0;       ///< l_D of all, with drag [1/s]; read only if there are dampers of materials
  double undamped = 0.0;          ///< l_K of the elements that hardly damp the fastest mode [1/s^2]
  double penalty = 0.0;           ///< largest k_c / m of penalty contact [1/s^2]; included in `elastic`
  double drag = 0.0;          ///< largest damping of a particle on its own, such as air drag, by its mass [1/s]; included in both
  double damping_time = 0.0;  ///< smallest c / k of elements with stiffness [s]: a mode is damped by this times omega^2
  double least_drag = 0.0;    ///< as `drag`, the smallest [1/s]
  std::string strictest{};    ///< name of the force that bounds the step most
};

/// Inverse masses [1/kg] of n particles, 0 of pinned ones.
[[nodiscard]] SpectralBounds spectral_bounds(const std::vector<LinearElement>& elements, const Scalars& inverse_masses);

/// Upper bounds of `elastic` and `damping` at little cost.
[[nodiscard]] SpectralBounds quick_bounds(const std::vector<LinearElement>& elements, const Scalars& inverse_masses);

}  // namespace sprung
