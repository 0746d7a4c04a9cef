// Safe region of an element before a primitive. Primitives are convex, so one plane suffices.
#pragma once

#include "collision/primitives/convex_separating_plane.h"
#include "collision/primitives/primitive_distance.h"
#include "collision/safe_regions/safe_region.h"

#include <algorithm>

namespace sprung {

/// Builds the safe region: the requested box and, if the primitive intersects it, the best separating plane. The region is broken
/// if the element is within rounding of the primitive. Then `distance`, `point` and `normal` describe the shortest displacement
/// that separates the element from the primitive.
template <class Primitive>
requires requires(const Primitive& primitive) { bounds(primitive); }
[[nodiscard]] SafeRegion find_region(const Primitive& primitive, const ElementCorners& element, const SafeRegionRequest& request) {
  SafeRegion region{.box = requested_box(element, request), .clear = request.reach};
  if (!region.box.intersects(bounds(primitive))) return region;
  const SeparatingPlane best = separation(primitive, element, region.box);
  if (!is_touching(lowest(region.box, best.normal) - best.height, request)) return region;

  region.normal = best.normal;
  if (is_touching(best.gap, request)) {
    region.broken = true;
    region.clear = 0.0;
    region.distance = best.gap;
    region.weights = Vector3::Unit(best.lowest_corner);
    region.point = element.x[static_cast<std::size_t>(best.lowest_corner)] - best.gap * best.normal;
    return region;
  }
  region.clear = best.gap;
  region.distance = best.distance;
  region.point = best.point;
  region.weights = best.weights;
  region.planes[0] = {best.normal, std::min(best.height + stand_off(best.gap, request), best.lowest)};
  region.plane_count = 1;
  return region;
}

}  // namespace sprung
