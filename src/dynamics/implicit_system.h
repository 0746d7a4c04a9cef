// The linear equations of an implicit step.
#pragma once

#include "dynamics/force.h"
#include "network/spring_network.h"

#include <memory>

namespace sprung {

/// (M - h dF/dv - h^2 dF/dx) y = b among free particles. Solved by a sparse Cholesky factor whose pattern is analysed once: where a
/// cloth is taut, conjugate gradients need a third of its time, where it is slack and swings several times as much, and the factor
/// needs no tolerance. One thread; the time grows with about the 3/2th power of a cloth's particles.
class ImplicitSystem {
 public:
  /// Keeps a reference to the network. `derivatives` are those of `make_derivatives`, for the pattern.
  ImplicitSystem(const SpringNetwork& network, const ForceDerivatives& derivatives);
  ~ImplicitSystem();

  /// Writes the matrix; `dt` is h [s].
  void assemble(const ForceDerivatives& derivatives, double dt);

  /// Lets the solution of a free particle have the part `vector` in that vector's direction, whatever its equations say; across it
  /// stays free (the constraints of Baraff and Witkin 1998, by weight). After `assemble`, before `solve`.
  void hold(Index particle, const Vector3& vector, Points& right);

  /// Replaces the right-hand sides b of free particles by the solution y, and those of pinned particles by zero; 3 x n. Not finite
  /// when the matrix is not.
  void solve(Points& vectors);

 private:
  struct Factor;

  void analyze();
  void fill();

  const SpringNetwork& network_;
  BlockMatrix blocks_;          // of the whole network, pinned particles included
  std::vector<Index> unknown_;  // of each particle its number among the free ones, or kNone
  Index free_count_ = 0;
  std::unique_ptr<Factor> factor_;
};

}  // namespace sprung
