// Derivatives of forces, for implicit schemes.
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/numerics/block_matrix.h"

#include <vector>

namespace sprung {

/// Symmetric matrices without positive eigenvalues.
struct ForceDerivatives {
  BlockMatrix by_position;  ///< dF/dx [N/m]
  BlockMatrix by_velocity;  ///< dF/dv [N s/m]
};

/// Zero derivatives with the pairs of all forces, and with further ones, for `differentiate`.
[[nodiscard]] ForceDerivatives make_derivatives(const Forces& forces, Index particles, std::vector<ParticlePair> pairs = {});

/// Writes the derivatives of the sum of all forces to `derivatives`, which `make_derivatives` made for the same forces.
void differentiate(const Forces& forces, const Kinematics& at, ForceDerivatives& derivatives);

}  // namespace sprung
