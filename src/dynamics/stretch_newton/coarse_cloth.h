// A coarse copy of a cloth: about every other row and column.
#pragma once

#include "dynamics/stretch_newton/stretch_component.h"

#include <array>
#include <optional>
#include <vector>

namespace sprung {

/// A cloth with fewer particles, and the interpolation from its points to the particles of the fine cloth.
struct CoarseCloth {
  /// The interpolation of a free fine particle from coarse points.
  struct Interpolation {
    std::array<Index, 4> points;    ///< corners of the coarse cell that contains it
    std::array<double, 4> weights;  ///< of the points [1]; their sum is 1
  };

  StretchComponent component;    ///< its points are coarse points, numbered row by row; masses are distributed by weights
  std::vector<Index> particles;  ///< of the network, by coarse point
  std::vector<Index> pins;       ///< coarse points that are pinned; the component contains those linked to free ones
  std::vector<Interpolation> interpolations;  ///< of the free points of the fine cloth
};

/// Makes the coarse copy of a component of the network that springs of `kinds` join. Coarse rows and columns are about two apart,
/// closer beside an isolated pin. Links join neighbours along rows and columns, and across cells where shear springs are limited.
/// Each link is as long as the springs that it replaces, so its limit is satisfied while theirs are. Returns none unless the
/// component is all free particles of a cloth from make_cloth whose limited springs include the structural ones and no other
/// kinds, and if pins would keep more than half of its particles.
[[nodiscard]] std::optional<CoarseCloth> coarsen(const SpringNetwork& network, const StretchComponent& component,
                                                 const std::vector<SpringKind>& kinds);

}  // namespace sprung
