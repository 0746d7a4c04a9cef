// A cloth of every other row and column of another.
#pragma once

#include "dynamics/stretch_newton/stretch_component.h"

#include <array>
#include <optional>
#include <vector>

namespace sprung {

/// A cloth of fewer particles in place of another, and where those of the other lie in it.
struct CoarseCloth {
  /// Where a free particle of the cloth lies among the points of the coarse one.
  struct Place {
    std::array<Index, 4> points;    ///< the corners of the cell that it lies in
    std::array<double, 4> weights;  ///< of them, dimensionless; their sum is 1
  };

  StretchComponent component;    ///< its particles are coarse points, numbered row by row; masses are shared out by weights
  std::vector<Index> particles;  ///< of the network, by coarse point
  std::vector<Index> pins;       ///< coarse points that are pinned; the component has those that links join to free ones
  std::vector<Place> places;     ///< of the free points of the cloth that it was made of
};

/// Of a component of the network that springs of `kinds` join. Coarse rows and columns are about two apart, nearer where a pin lies
/// that is not among others. Links join neighbours along them, and across cells where shear springs are limited; they are as long
/// as what they take the place of: while those hold, so do they. None for what is not all free particles of a cloth, joined as by
/// make_cloth with structural springs among those that are limited and by no others, or has so many pins that half of its particles
/// would be left.
[[nodiscard]] std::optional<CoarseCloth> coarsen(const SpringNetwork& network, const StretchComponent& component,
                                                 const std::vector<SpringKind>& kinds);

}  // namespace sprung
