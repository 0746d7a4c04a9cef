// The interface of solvers that enforce the limit of one component.
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"

#include <optional>

namespace sprung {

/// Threshold below which a component rests, as a fraction of the initial inertia term: it ignores a displacement of all points by
/// 1/600 of the force displacement, which is what gravity restores at an inclination of a tenth of a degree. With 1/100 cloths
/// stopped nearly a degree before their turning point and leaned 38 % too far in light wind. A threshold on the total energy would
/// not do: the links' share of it grows as the step shrinks, and taut bodies stopped 10 degrees askew.
inline constexpr double kBalanced = 2.0 / (600.0 * 600.0);

/// Enforces the limit of one component's links globally, before the passes.
class ComponentSolver {
 public:
  virtual ~ComponentSolver() = default;

  /// Moves the component's free particles from the target of the forces, `positions` [m], 3 x particles, to positions where no
  /// link is much too long. `before` are the positions at the beginning of the step. `steady_displacement` [m] is the displacement
  /// of a particle at rest by the largest steady acceleration in a step, |g| dt^2. Returns the number of linear systems solved;
  /// none if no link was too long.
  virtual std::optional<int> solve(const Points& before, Points& positions, double steady_displacement) = 0;

  /// Discards what former solves left behind, such as a factor: the next solve is that of a new solver.
  virtual void forget() = 0;

  /// Writes what forget() discards, and reads it back. load() throws BytesError if it is of another component.
  virtual void save(ByteWriter& to) const = 0;
  virtual void load(BinaryReader& from) = 0;

  /// Largest relative deformation in the last solve() [1]: the largest displacement of a point by forces minus the common
  /// displacement, divided by the component's extent. For a body that swings about its pins this is the angle of the step.
  [[nodiscard]] virtual double deformation() const = 0;
};

}  // namespace sprung
