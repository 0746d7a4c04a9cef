// Free space around an element of the network between a mesh's triangles.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/safe_region.h"

namespace sprung {

/// Makes the region of an element in the mesh's frame: the nearest triangle, and each one that comes within the box and is not
/// behind a plane already, gives a plane between, a smaller box, or, where there are many, a radius. The search for the nearest
/// begins with the region's triangle, left from the element's last region.
void find_region(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region);

/// Where the nearest points of an element and a mesh lie.
struct NearestSpot {
  Index triangle = kNone;
  PairPlace place{};  ///< on element and triangle
};

/// That of an element which is nearer than `exact`, else the last, with which the search begins.
[[nodiscard]] NearestSpot nearest_spot(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request,
                                       const NearestSpot& last);

}  // namespace sprung
