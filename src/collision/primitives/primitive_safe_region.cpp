#include "collision/primitives/primitive_safe_region.h"

#include "collision/primitives/convex_separating_plane.h"
#include "collision/primitives/primitive_distance.h"

#include <algorithm>

namespace sprung {

namespace {

template <class Shape>
Zone zone_against(const Shape& shape, const ElementCorners& element, const ZoneRequest& request) {
  Zone zone{.box = asked_box(element, request), .clear = request.reach};
  if (!zone.box.intersects(bounds(shape))) return zone;
  const Separation best = separation(shape, element, zone.box);
  if (!is_touching(lowest(zone.box, best.normal) - best.height, request)) return zone;

  zone.normal = best.normal;
  if (is_touching(best.gap, request)) {
    zone.broken = true;
    zone.clear = 0.0;
    zone.distance = best.gap;
    zone.weights = Vector3::Unit(best.lowest_corner);
    zone.point = element.x[static_cast<std::size_t>(best.lowest_corner)] - best.gap * best.normal;
    return zone;
  }
  zone.clear = best.gap;
  zone.distance = best.distance;
  zone.point = best.point;
  zone.weights = best.weights;
  zone.planes[0] = {best.normal, std::min(best.height + stand_off(best.gap, request), best.lowest)};
  zone.plane_count = 1;
  return zone;
}

}  // namespace

Zone find_zone(const SphereGeometry& sphere, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(sphere, element, request);
}
Zone find_zone(const BoxGeometry& box, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(box, element, request);
}
Zone find_zone(const CapsuleGeometry& capsule, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(capsule, element, request);
}
Zone find_zone(const CylinderGeometry& cylinder, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(cylinder, element, request);
}
Zone find_zone(const ConeGeometry& cone, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(cone, element, request);
}
Zone find_zone(const EllipsoidGeometry& ellipsoid, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(ellipsoid, element, request);
}
Zone find_zone(const HalfSpaceGeometry& half_space, const ElementCorners& element, const ZoneRequest& request) {
  return zone_against(half_space, element, request);
}

}  // namespace sprung
