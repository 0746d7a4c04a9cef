#include "collision/convex_zone.h"

#include "collision/convex_separation.h"
#include "collision/primitive_distance.h"

#include <algorithm>

namespace sprung {

namespace {

// A plane stands off the obstacle by this part of the gap: the rest is free for the element.
constexpr double kStandOff = 0.3;

// Below this part of the clearance, which is 2^-42 of the coordinates, a gap is not told from rounding.
constexpr double kTouching = 0x1p-12;

Box3 box_around(const ElementCorners& element, double reach) {
  Box3 box;
  for (int i = 0; i < element.count; ++i) box.extend(element.x[static_cast<std::size_t>(i)]);
  return {box.min() - Vector3::Constant(reach), box.max() + Vector3::Constant(reach)};
}

/// No element is asked to come nearer than it is, and half of the gap that contact keeps is left to contact.
double stand_off(double gap, const ZoneRequest& request) {
  return std::min(gap, std::max(request.clearance, std::min(kStandOff * gap, 0.5 * request.gap)));
}

template <class Shape>
Zone zone_against(const Shape& shape, const ElementCorners& element, const ZoneRequest& request) {
  Zone zone;
  zone.box = box_around(element, request.reach);
  if (!zone.box.intersects(bounds(shape))) return zone;
  const Separation best = separation(shape, element, zone.box);
  if (lowest(zone.box, best.normal) > best.height + kTouching * request.clearance) return zone;

  zone.normal = best.normal;
  if (!(best.gap > kTouching * request.clearance)) {
    zone.broken = true;
    zone.distance = best.gap;
    zone.weights = Vector3::Unit(best.lowest_corner);
    zone.point = element.x[static_cast<std::size_t>(best.lowest_corner)] - best.gap * best.normal;
    return zone;
  }
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
