// Normal-cone test: fans of triangles that are too flat to cross themselves.
#pragma once

#include "collision/element_bvh/vertex_bounds.h"
#include "collision/surface/surface_topology.h"

namespace sprung {

/// Whether the triangles around a particle cannot cross each other for `horizon` [steps] from now while their corners stay within
/// their spheres. That is so if all triangles keep facing one direction and surround the particle less than once or, in a closed
/// fan, exactly once (Volino and Magnenat-Thalmann 1994). False where this is not certain.
[[nodiscard]] bool fan_stays_flat(const SurfaceTopology& features, Index particle, const VertexBounds& spheres, double horizon);

}  // namespace sprung
