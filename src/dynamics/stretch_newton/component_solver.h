// What brings the limited springs of one component within their limit.
#pragma once

#include "base/types.h"

#include <optional>

namespace sprung {

/// What would lead all points by a six hundredth of the way from where forces led is worth this part of the inertia at first, and
/// not moved: what gravity pulls back that hangs a tenth of a degree askew. With a hundredth cloths stopped where they turned
/// round, nearly a degree askew, and leaned 38 % too far in a light wind. Of the energy it would be far more, as links' part of
/// that grows the smaller the steps, and need not fall: what was drawn taut stopped 10 degrees askew.
inline constexpr double kBalanced = 2.0 / (600.0 * 600.0);

/// What brings the free particles of one component towards the limit of its links, all at once, before the passes do.
class ComponentSolver {
 public:
  virtual ~ComponentSolver() = default;

  /// Leads the component's free particles on from where forces led them, `positions` [m], 3 x particles, to where no link is much
  /// too long; `before` is where the step began, `fall` [m] how far the largest steady acceleration leads a particle at rest in a
  /// step, |g| dt^2. Returns how many linear systems were solved; none when no link that it solves for was too long.
  virtual std::optional<int> solve(const Points& before, Points& positions, double fall) = 0;

  /// How far the point that goes farthest by itself was led by the forces of the last `solve`, as a part of the component's extent:
  /// of what swings about its pins, the angle of a step.
  [[nodiscard]] virtual double turn() const = 0;
};

}  // namespace sprung
