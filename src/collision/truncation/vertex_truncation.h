// Where particles end that obstacles do not let go where they want.
#pragma once

#include "collision/obstacle_regions/obstacle_safe_regions.h"

#include <vector>

namespace sprung {

/// What became of a particle on its way.
enum class Outcome : char {
  free,       ///< it arrived
  stopped,    ///< it ended elsewhere, where it may be
  infeasible  ///< no such place was found
};
using Outcomes = std::vector<Outcome>;

[[nodiscard]] Index count(const Outcomes& outcomes, Outcome wanted);

/// Leaves infeasible what was so before.
void keep_infeasible(const Outcomes& before, Outcomes& outcomes);

/// Moves a particle to where its way leads, or to a place near there within the regions of its elements. One that finds none stays
/// with an obstacle that carries it.
Outcome place(const ObstacleSafeRegions& regions, Index particle, const Way& way, Points& positions);

/// The same for many, each on its own.
Outcomes place(const ObstacleSafeRegions& regions, const std::vector<Index>& particles, const Way& way, Points& positions);

}  // namespace sprung
