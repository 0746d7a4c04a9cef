// A knot invariant: a number that changes only if the rope passes through itself.
#pragma once

#include "base/types.h"

namespace sprung::testing {

/// The determinant of the knot of a closed polyline: 1 for a ring, 3 for an overhand knot, 5 for a figure of eight. It belongs to
/// the equations of Fox colourings of the projection: at each crossing, twice the colour of the strand above equals the sum of the
/// colours of the strands below (Crowell and Fox 1963). Requires positions [m], 3 x n, in general position.
[[nodiscard]] int knot_determinant(const Points& closed_polyline);

/// The polyline of a rope, closed by a wide arc far from it. Requires that the rope's ends are outside of the rest.
[[nodiscard]] Points closed_far_away(const Points& rope);

}  // namespace sprung::testing
