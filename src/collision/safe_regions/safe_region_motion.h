// Zones before a mesh that deforms.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/safe_region.h"

namespace sprung {

/// Shifts a region between the triangles of `before` to where they are in `after`: by `region.drift`, which is how far the surface
/// went where it was nearest, and smaller by how much otherwise any triangle went that comes near the region on the way. While both
/// go on straight, all corners that begin in the one region and end in the other stay clear of all triangles. Requires trees of the
/// same triangles, whose boxes hold both positions.
void shift(SafeRegion& region, const MeshBvh& before, const MeshBvh& after);

}  // namespace sprung
