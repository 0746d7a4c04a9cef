// Zones of elements against primitives: all are convex, so one plane separates.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

namespace sprung {

/// The region of an element against a primitive: its box, and the plane of the best separation where the primitive comes within the
/// box. Elements within rounding of the primitive are broken; then distance, point and normal are those of the direction in which
/// the element has the least to go to be free of it.
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
