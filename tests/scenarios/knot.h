// Which knot a rope is tied in, told by a number that no motion changes unless the rope passes through itself.
#pragma once

#include "base/types.h"

namespace sprung::testing {

/// The determinant of the knot that a closed polyline makes: 1 for a ring, 3 for an overhand knot, 5 for a figure of eight. It
/// counts the colourings of the polyline's shadow: at each crossing twice the strand above is the sum of both ends below (Fox;
/// Crowell and Fox 1963). Requires positions [m], 3 x n, in general position.
[[nodiscard]] int knot_determinant(const Points& closed_polyline);

/// The polyline of a rope, closed by a wide arc far from it. Requires that the rope's ends are outside of the rest.
[[nodiscard]] Points closed_far_away(const Points& rope);

}  // namespace sprung::testing
