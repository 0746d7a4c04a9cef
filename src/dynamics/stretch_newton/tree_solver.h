// Elimination along chains and trees.
#pragma once

#include "dynamics/stretch_newton/stretch_system.h"

namespace sprung {

/// Block elimination from the tips to the root and substitution back: exact, linear in the particles, block-tridiagonal for chains.
class TreeSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component. Requires that it is a tree.
  explicit TreeSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;
  void solve_again(const StretchSystem& system, Points& step) override { solve(system, step); }

 private:
  struct Node {
    SymmetricMatrix3 own;      ///< mass and the stiffness of what hangs on the point
    SymmetricMatrix3 upward;   ///< block between the point and the one it hangs on
    SymmetricMatrix3 inverse;  ///< of all the point's stiffness
    Index parent = kNone;
  };
  void eliminate(const StretchSystem& system, Points& step);

  const StretchComponent& component_;
  std::vector<Node> nodes_;
};

}  // namespace sprung
