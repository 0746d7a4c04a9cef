// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/block_cholesky.h"
#include "dynamics/stretch_system.h"

#include <optional>

namespace sprung {

/// A new factor for each system, or the last one as preconditioner of conjugate gradients for a system that is like the one before,
/// where few iterations come near enough. So solutions depend on the systems before, in their later digits; the same systems one
/// after the other have the same bits.
class SparseSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit SparseSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;

 private:
  void assemble(const StretchSystem& system);
  [[nodiscard]] std::optional<double> approach(const Points& right, Points& step);

  const StretchComponent& component_;
  BlockMatrix matrix_;  ///< M + K
  BlockCholesky factor_;
  bool factored_ = false;  ///< whether there is a factor, of this system or of one before

  // Of conjugate gradients, 3 x free.
  Points left_;
  Points towards_;
  Points direction_;
  Points pushed_;
};

}  // namespace sprung
