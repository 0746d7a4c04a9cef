// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/block_cholesky.h"
#include "dynamics/stretch_system.h"

namespace sprung {

/// A new factor for each system. One of an earlier system, as preconditioner of conjugate gradients, takes longer: a factor is
/// worth six or seven solves, and what is slack in one iteration is taut in the next.
class SparseSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit SparseSolver(const StretchComponent& component);
  void solve(const StretchSystem& system, Points& step) override;

 private:
  void assemble(const StretchSystem& system);

  const StretchComponent& component_;
  BlockMatrix matrix_;  ///< M + K
  BlockCholesky factor_;
};

}  // namespace sprung
