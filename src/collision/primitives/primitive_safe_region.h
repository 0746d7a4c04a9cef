// Zones of elements against primitives: all are convex, so one plane separates.
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

namespace sprung {

/// The zone of an element against a primitive: its box, and the plane of the best separation where the primitive comes within the
/// box. Elements within rounding of the primitive are broken; then distance, point and normal are those of the direction in which
/// the element has the least to go to be free of it.
[[nodiscard]] Zone find_zone(const SphereGeometry& sphere, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const BoxGeometry& box, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const CapsuleGeometry& capsule, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const CylinderGeometry& cylinder, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const ConeGeometry& cone, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const ZoneRequest& request);
[[nodiscard]] Zone find_zone(const HalfSpaceGeometry& half_space, const ElementCorners& element, const ZoneRequest& request);

}  // namespace sprung
