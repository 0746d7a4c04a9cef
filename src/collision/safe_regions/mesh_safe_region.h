// Safe region of an element before a triangle mesh, and its motion with a mesh that deforms.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/safe_region.h"

namespace sprung {

/// Builds the safe region of an element, in the frame of the mesh. Each triangle that intersects the box and is not behind a plane
/// adds a plane; once all planes are used it shrinks the box or the radius instead. The nearest triangle comes first. The search
/// starts with `region.triangle`, the result of the element's previous search.
void find_region(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region);

/// The triangle nearest to an element, and the features that contain the closest points.
struct ClosestFeatures {
  Index triangle = kNone;
  FeaturePair features{};  ///< of element and triangle
};

/// Finds the closest triangle within `request.exact` [m]. The search starts with `last`; returns `last` if no triangle is that
/// near.
[[nodiscard]] ClosestFeatures closest_features(const MeshBvh& tree, const ElementCorners& element, const SafeRegionRequest& request,
                                               const ClosestFeatures& last);

/// Moves a region, built for the triangles of `before`, with the surface to `after`. The region is translated by `region.drift`,
/// the displacement of the surface at the closest point. It then shrinks by the largest difference between `drift` and the
/// displacement of a triangle near its path. While triangles and corners move along straight lines, no triangle touches an element
/// whose corners start in the old region and end in the new one. Requires two trees of the same triangles with boxes that contain
/// both positions.
void shift(SafeRegion& region, const MeshBvh& before, const MeshBvh& after);

}  // namespace sprung
