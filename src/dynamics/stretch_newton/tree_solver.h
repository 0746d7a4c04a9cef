// Elimination along chains and trees.
#pragma once

#include "dynamics/stretch_newton/stretch_system.h"

namespace sprung {

/// Block elimination from the leaves to the root and back substitution: exact, linear in the particles, block-tridiagonal for
/// chains.
class TreeSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component, which must be a tree.
  explicit TreeSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;
  void solve_again(const StretchSystem& system, Points& step) override { solve(system, step); }

 private:
  struct Node {
    SymmetricMatrix3 own;      ///< mass plus the stiffness of the subtree below the point
    SymmetricMatrix3 upward;   ///< block between the point and the one it hangs on
    SymmetricMatrix3 inverse;  ///< of the point's total stiffness
    Index parent = kNone;
  };
  void eliminate(const StretchSystem& system, Points& step);

  const StretchComponent& component_;
  std::vector<Node> nodes_;
};

}  // namespace sprung
