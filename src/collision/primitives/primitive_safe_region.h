// Safe region of an element before a primitive. Primitives are convex, so one plane suffices.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

namespace sprung {

/// Builds the safe region: the requested box and, if the primitive intersects it, the best separating plane. The region is broken
/// if the element is within rounding of the primitive. Then `distance`, `point` and `normal` describe the shortest displacement
/// that separates the element from the primitive.
[[nodiscard]] SafeRegion find_region(const SphereGeometry& sphere, const ElementCorners& element, const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const BoxGeometry& box, const ElementCorners& element, const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const CapsuleGeometry& capsule, const ElementCorners& element,
                                     const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const CylinderGeometry& cylinder, const ElementCorners& element,
                                     const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const ConeGeometry& cone, const ElementCorners& element, const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const EllipsoidGeometry& ellipsoid, const ElementCorners& element,
                                     const SafeRegionRequest& request);
[[nodiscard]] SafeRegion find_region(const HalfSpaceGeometry& half_space, const ElementCorners& element,
                                     const SafeRegionRequest& request);

}  // namespace sprung
