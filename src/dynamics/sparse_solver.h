// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/stretch_system.h"

#include <memory>

namespace sprung {

/// Conjugate gradients, with the Cholesky factor of an earlier system of the step as preconditioner; a new factor is made when they
/// take too long. The factor's pattern is found once, ordered by minimum degree (Amestoy, Davis and Duff 1996).
class SparseSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit SparseSolver(const StretchComponent& component);
  ~SparseSolver() override;
  void begin_step() override;
  void solve(const StretchSystem& system, Points& step) override;

 private:
  class Factor;
  [[nodiscard]] bool conjugate_gradients(const StretchSystem& system, Points& step);
  void multiply(const StretchSystem& system, const Points& direction, Points& product) const;

  const StretchComponent& component_;
  std::unique_ptr<Factor> factor_;
  Points residual_;
  Points preconditioned_;
  Points direction_;
  Points product_;
};

}  // namespace sprung
