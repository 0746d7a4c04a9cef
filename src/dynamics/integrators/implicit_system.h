// The linear equations of an implicit step.
#pragma once

#include "dynamics/forces/force.h"
#include "dynamics/numerics/block_cholesky.h"
#include "network/spring_network.h"

namespace sprung {

/// (M - h dF/dv - h^2 dF/dx) y = b among free particles, by a sparse factor whose pattern is found once. It needs no tolerance,
/// unlike conjugate gradients; its time grows with about the 3/2th power of a cloth's particles. One thread.
class ImplicitSystem {
 public:
  /// Keeps a reference to the network. `derivatives` are those of `make_derivatives`, for the pattern.
  ImplicitSystem(const SpringNetwork& network, const ForceDerivatives& derivatives);

  /// Writes the matrix; `dt` is h [s].
  void assemble(const ForceDerivatives& derivatives, double dt);

  /// Keeps the solution of a free particle from going where this projects to, whatever its equations say; elsewhere it stays free
  /// (the constraints of Baraff and Witkin 1998, by weight). Thread-safe for different particles; for each after `assemble`, once
  /// at most. Zero holds nothing.
  void hold(Index particle, const Matrix3& projection);

  /// Replaces the right-hand sides b of free particles by the solution y, and those of pinned particles by zero; 3 x n. Not finite
  /// when the matrix is not.
  void solve(Points& vectors);

 private:
  const SpringNetwork& network_;
  BlockMatrix matrix_;  ///< of the whole network, pinned particles included
  BlockCholesky<double> factor_;
};

}  // namespace sprung
