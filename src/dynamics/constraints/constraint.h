// The interface of constraints on positions.
#pragma once

#include "base/types.h"
#include "dynamics/state/recorded_impulses.h"

#include <memory>
#include <optional>
#include <vector>

namespace sprung {

/// A condition on positions that the passes of a step restore, beside contact and the stretch limit, after forces have moved the
/// particles (position-based dynamics: Mueller et al. 2007). Displacements become velocities at the end of the step.
///
/// A simulator calls a constraint from one thread at a time. If none of its members changes it, `prepare` included, it may belong
/// to several simulators that run at the same time, such as copies of one. Change its parameters while none of them runs. A substep
/// calls project() and residual() once per pass, up to some dozen times.
///
/// Inverse masses change when particles are pinned, released, fall asleep or wake: a constraint that needs them copies them from
/// Simulator::network() anew after each change.
class Constraint {
 public:
  virtual ~Constraint() = default;

  /// Prepares the constraint for passes of a step that ends at `time` [s]. Not thread-safe. Default: does nothing.
  virtual void prepare(double time);

  /// The particles that the constraint moves, now or later; none: any. Those of an added constraint stay awake.
  /// Simulator::add_constraint asks for them: call Simulator::wake() after they changed. Default: any.
  [[nodiscard]] virtual std::optional<std::vector<Index>> touched() const;

  /// One Gauss-Seidel pass over `positions` [m], 3 x n, of a step that began at `before`. Each particle moves in proportion to its
  /// inverse mass, so that momentum is conserved; pinned particles do not move. Gives the same bits for any number of threads.
  /// Adds to the recorder what a pinned particle withstands: minus the momentum that the rest of its stencil gained. To record
  /// nothing is right for a constraint that holds its particles in space. Returns the residual at the start of the pass.
  virtual double project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const = 0;

  /// The largest violation as a multiple of what is tolerated: passes end once it is at most 1.
  [[nodiscard]] virtual double residual(const Points& positions) const = 0;
};

using Constraints = std::vector<std::shared_ptr<Constraint>>;

/// One pass over all constraints. Returns the largest residual at its start; 0 without constraints.
double project(const Constraints& constraints, const Points& before, Points& positions, const ImpulseRecorder& recorder);

/// The largest residual; 0 without constraints.
[[nodiscard]] double residual(const Constraints& constraints, const Points& positions);

}  // namespace sprung
