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
/// A constraint belongs to one simulator, which calls it from one thread at a time and sets its recorder. Change its parameters
/// between steps. A substep calls project() and residual() once per pass, up to some dozen times.
class Constraint {
 public:
  virtual ~Constraint() = default;

  /// Prepares the constraint for passes of a step that ends at `time` [s]. Not thread-safe. Default: does nothing.
  virtual void prepare(double time);

  /// The particles that the constraint moves, now or later; none: any. Those of an added constraint stay awake. Default: any.
  [[nodiscard]] virtual std::optional<std::vector<Index>> touched() const;

  /// One Gauss-Seidel pass over `positions` [m], 3 x n, of a step that began at `before`. Each particle moves in proportion to its
  /// inverse mass, so that momentum is conserved; pinned particles do not move. Gives the same bits for any number of threads.
  /// Returns the residual at the start of the pass.
  virtual double project(const Points& before, Points& positions) const = 0;

  /// The largest violation as a multiple of what is tolerated: passes end once it is at most 1.
  [[nodiscard]] virtual double residual(const Points& positions) const = 0;

  /// Lets the next calls of project() record impulses, so that pins know what they hold.
  void record(const ImpulseRecorder& recorder) { recorder_ = recorder; }

 protected:
  /// Where project() adds what a pinned particle withstands: minus the momentum that the rest of its stencil gained. To record
  /// nothing is right for a constraint that holds its particles in space. Often off.
  [[nodiscard]] const ImpulseRecorder& recorder() const { return recorder_; }

 private:
  ImpulseRecorder recorder_;
};

using Constraints = std::vector<std::shared_ptr<Constraint>>;

/// One pass over all constraints. Returns the largest residual at its start; 0 without constraints.
double project(const Constraints& constraints, const Points& before, Points& positions);

/// The largest residual; 0 without constraints.
[[nodiscard]] double residual(const Constraints& constraints, const Points& positions);

}  // namespace sprung
