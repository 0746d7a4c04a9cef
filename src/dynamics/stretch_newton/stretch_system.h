// The linear system of a Newton iteration on a component, and the interface of its solvers.
#pragma once

#include "base/files/binary_archive.h"
#include "dynamics/numerics/symmetric_matrix3.h"
#include "dynamics/stretch_newton/stretch_component.h"

#include <memory>
#include <span>
#include <vector>

namespace sprung {

/// (M + K) dx = residual. M holds the masses of free points. K holds the block of each link, added at its ends and subtracted
/// between them. Pinned points do not move.
struct StretchSystem {
  std::vector<SymmetricMatrix3> blocks;   ///< of links, positive semidefinite [kg]
  std::vector<SymmetricMatrix3> of_rods;  ///< of rods: w_j w_k times the block couples the points j and k of weights w [kg]
  std::span<const RodRow> rows;           ///< by number of a rod
  Points residual;                        ///< imbalance at free points [kg m], 3 x free
  bool is_like_last = false;              ///< the previous system was similar: its factor may be reused,
  double may_be_left = 0.0;               ///< and a solution may leave this much unused energy [kg m^2]
};

class StretchSystemSolver {
 public:
  virtual ~StretchSystemSolver() = default;

  /// Writes the displacements [m] of free points to `step`, 3 x free. Exact for trees; otherwise up to a tenth of the residual may
  /// remain. Not finite if the system is not. Returns an estimate of the modelled energy that a better displacement would still
  /// gain [kg m^2]; 0 if exact.
  virtual double solve(const StretchSystem& system, Points& step) = 0;

  /// Solves with the blocks of the last system and another residual, by one application of their factor.
  virtual void solve_again(const StretchSystem& system, Points& step) = 0;

  /// Discards factors of former systems. Default: does nothing, for a solver that keeps none.
  virtual void forget() {}

  /// Writes these factors, and reads them back. load() throws BytesError if they are of another component. Default: does nothing.
  virtual void save(ByteWriter& /*to*/) const {}
  virtual void load(BinaryReader& /*from*/) {}
};

/// TreeSolver for trees, otherwise PcgSolver. Keeps a reference to the component.
[[nodiscard]] std::unique_ptr<StretchSystemSolver> make_system_solver(const StretchComponent& component);

}  // namespace sprung
