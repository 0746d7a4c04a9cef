// Moves safe regions with a mesh that deforms.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/safe_region.h"

namespace sprung {

/// Moves a region, built for the triangles of `before`, with the surface to `after`. The region is translated by `region.drift`,
/// the displacement of the surface at the closest point. It then shrinks by the largest difference between `drift` and the
/// displacement of a triangle near its path. While triangles and corners move along straight lines, no triangle touches an element
/// whose corners start in the old region and end in the new one. Requires two trees of the same triangles with boxes that contain
/// both positions.
void shift(SafeRegion& region, const MeshBvh& before, const MeshBvh& after);

}  // namespace sprung
