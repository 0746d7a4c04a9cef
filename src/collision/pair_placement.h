// Where particles end that are in each other's way.
#pragma once

#include "collision/particle_placement.h"
#include "collision/self_zones.h"

namespace sprung {

/// Keeps the sides of pairs apart that would pass each other on the way from `before` to `after` [m], 3 x n, which obstacles allow:
/// changes `after` to places that both do. What finds none stays with its neighbours: an obstacle can be left again, a knot in a
/// cloth stays. Returns what became of those that were held. Requires SelfZones::begin_step() with the same `before`.
Outcomes place_apart(const ObstacleZones& zones, SelfZones& pairs, const Points& before, Points& after);

}  // namespace sprung
