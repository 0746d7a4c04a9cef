// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/block_cholesky.h"
#include "dynamics/stretch_system.h"

namespace sprung {

/// Conjugate gradients, with the Cholesky factor of an earlier system of the step as preconditioner; a new factor is made when they
/// take too long.
class SparseSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit SparseSolver(const StretchComponent& component);
  void begin_step() override;
  void solve(const StretchSystem& system, Points& step) override;

 private:
  void assemble(const StretchSystem& system);
  [[nodiscard]] bool conjugate_gradients(const StretchSystem& system, Points& step);
  void multiply(const StretchSystem& system, const Points& direction, Points& product) const;

  const StretchComponent& component_;
  BlockMatrix matrix_;  ///< M + K
  BlockCholesky factor_;
  bool is_made_ = false;  ///< the factor, in this step
  Points residual_;
  Points preconditioned_;
  Points direction_;
  Points product_;
};

}  // namespace sprung
