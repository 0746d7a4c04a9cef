// The linear system of an implicit step.
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/numerics/block_cholesky.h"
#include "network/model/spring_network.h"

namespace sprung {

/// (M - h dF/dv - h^2 dF/dx) y = b for the free particles, solved by a sparse factor. The pattern is found once. Unlike conjugate
/// gradients, the factor needs no tolerance; for a cloth its time grows with about the power 3/2 of the particles. Runs on one
/// thread.
class ImplicitSystem {
 public:
  /// Keeps a reference to the network. `derivatives`, from `make_derivatives`, give the pattern.
  ImplicitSystem(const SpringNetwork& network, const ForceDerivatives& derivatives);

  /// Computes the matrix; `dt` is h [s].
  void assemble(const ForceDerivatives& derivatives, double dt);

  /// Constrains the solution of a free particle to have no component in the range of `projection`, by a large weight (the
  /// constraints of Baraff and Witkin 1998), and adds `stiffness`, symmetric, to its equations. A zero projection constrains
  /// nothing. Returns what it added to the matrix. Call after `assemble`, at most once per particle. Thread-safe for different
  /// particles.
  Matrix3 constrain(Index particle, const Matrix3& projection, const Matrix3& stiffness = Matrix3::Zero());

  /// Constrains the weighted sum of the contact's particles in the same way. Its pairs must be in the pattern. Not thread-safe.
  Matrix3 constrain(const ElementContact& contact, const Matrix3& projection, const Matrix3& stiffness);

  /// Replaces the right-hand sides b of free particles by the solution y, and those of pinned particles by zero; 3 x n. The result
  /// is not finite if the matrix is not.
  void solve(Points& vectors);

 private:
  const SpringNetwork& network_;
  BlockMatrix matrix_;  ///< of the whole network, including pinned particles
  Scalars weights_;     ///< of constraints on each particle
  BlockCholesky<double> factor_;
};

}  // namespace sprung
