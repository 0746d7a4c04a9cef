#include "collision/primitives/primitive_safe_region.h"

#include "collision/primitives/convex_separating_plane.h"
#include "collision/primitives/primitive_distance.h"

#include <algorithm>

namespace sprung {

namespace {

template <class Shape>
SafeRegion region_against(const Shape& shape, const ElementCorners& element, const SafeRegionRequest& request) {
  SafeRegion region{.box = requested_box(element, request), .clear = request.reach};
  if (!region.box.intersects(bounds(shape))) return region;
  const SeparatingPlane best = separation(shape, element, region.box);
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

}  // namespace

SafeRegion find_region(const SphereGeometry& sphere, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(sphere, element, request);
}
SafeRegion find_region(const BoxGeometry& box, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(box, element, request);
}
SafeRegion find_region(const CapsuleGeometry& capsule, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(capsule, element, request);
}
SafeRegion find_region(const CylinderGeometry& cylinder, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(cylinder, element, request);
}
SafeRegion find_region(const ConeGeometry& cone, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(cone, element, request);
}
SafeRegion find_region(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(ellipsoid, element, request);
}
SafeRegion find_region(const HalfSpaceGeometry& half_space, const ElementCorners& element, const SafeRegionRequest& request) {
  return region_against(half_space, element, request);
}

}  // namespace sprung
