// A coarse copy of a chain or tree: about every other point.
#pragma once

#include "dynamics/stretch_newton/stretch_component.h"

#include <array>
#include <vector>

namespace sprung {

/// A tree with fewer points, and where the others are.
struct CoarseTree {
  /// A point that only the fine tree has, on a link of the coarse tree.
  struct Between {
    Index point;
    std::array<Index, 2> ends;      ///< of the coarse link
    std::array<double, 2> lengths;  ///< rest lengths of the fine links to them [m]
  };

  StretchComponent component;  ///< its points are points of the fine tree; masses are distributed by lengths
  std::vector<Between> between;

  /// Moves each point that only the fine tree has to the place nearest to its target where both of its links satisfy the limit,
  /// between ends as `x` has them. `target` and `x` are 3 x fine points.
  void place_others(const Points& target, double max_stretch, Points& x) const;
};

/// Leaves out every other point along each branch of a tree; ends, forks and what is linked to a pin stay. Each link is as long as
/// those that it replaces, so its limit is satisfied while theirs are.
[[nodiscard]] CoarseTree coarsen(const StretchComponent& tree);

}  // namespace sprung
