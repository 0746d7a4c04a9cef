// The linear equations of a Newton iteration on a stretch component, and what solves them.
#pragma once

#include "dynamics/numerics/symmetric_matrix3.h"
#include "dynamics/stretch_newton/stretch_component.h"

#include <memory>
#include <vector>

namespace sprung {

/// (M + K) dx = residual: M has the masses of free points, and K the block of each link, added at its ends and subtracted between
/// them. Pinned points do not move.
struct StretchSystem {
  std::vector<SymmetricMatrix3> blocks;  ///< of links, positive semidefinite [kg]
  Points residual;                       ///< what is out of balance at free points [kg m], 3 x free
  bool is_like_last = false;             ///< whether the system before was much the same: its factor may do,
  double may_be_left = 0.0;              ///< and so may a displacement that leaves this much to gain [kg m^2]
};

class StretchSystemSolver {
 public:
  virtual ~StretchSystemSolver() = default;

  /// Writes the free points' displacements [m] to `step`, 3 x free; exact for trees, of others a tenth of the residual may be left.
  /// Not finite when the system is not. Returns about how much of the energy that the system models another displacement would gain
  /// [kg m^2]: 0 where it is exact.
  virtual double solve(const StretchSystem& system, Points& step) = 0;

  /// The same for another residual beside the blocks that were solved last, as near as their factor comes at once.
  virtual void solve_again(const StretchSystem& system, Points& step) = 0;
};

/// TreeSolver for trees, else PcgSolver. Keeps a reference to the component.
[[nodiscard]] std::unique_ptr<StretchSystemSolver> make_system_solver(const StretchComponent& component);

}  // namespace sprung
