// Fans of triangles that cannot cross themselves, because they stay flat enough.
#pragma once

#include "collision/element_bvh/vertex_bounds.h"
#include "collision/surface/surface_topology.h"

namespace sprung {

/// Whether the triangles around a particle cannot cross each other, or come to, from now until `horizon` [steps] have passed, as
/// long as their corners stay within their balls: seen along one direction, all keep facing the eye, and go around it less than
/// once or, in a closed fan, just once (Volino and Magnenat-Thalmann 1994). False where this is not sure.
[[nodiscard]] bool fan_stays_flat(const SurfaceTopology& features, Index particle, const VertexBounds& balls, double horizon);

}  // namespace sprung
