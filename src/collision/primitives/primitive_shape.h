// A primitive as the shape of an obstacle, based on its signed distance, and the safe region of an element before it.
#pragma once

#include "collision/primitives/primitive_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

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

/// The first intersection of a path with a convex solid of signed distance `distance`. The distance is convex along the path and
/// above its tangents, so Newton steps never pass the surface. A tangent that stays positive proves that the rest of the path is
/// free.
[[nodiscard]] std::optional<Crossing> first_crossing_of_convex(const std::function<SurfacePoint(const Vector3&)>& distance,
                                                               double rounding, const Vector3& a, const Vector3& b);

template <class Geometry>
class PrimitiveShape final : public ObstacleShape {
 public:
  explicit PrimitiveShape(const Geometry& geometry) : geometry_(geometry) {}

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const override {
    const SurfacePoint found = surface_point(geometry_, p);
    if (!(found.distance < radius)) return std::nullopt;
    return found;
  }

  [[nodiscard]] std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const override {
    return first_crossing_of_convex([this](const Vector3& p) { return surface_point(geometry_, p); },
                                    std::max(rounding(a), rounding(b)), a, b);
  }

  void find_region(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) const override {
    region = sprung::find_region(geometry_, element, request);
  }

  void update_closest_points(const ElementCorners& element, const SafeRegionRequest& request, bool /*fresh*/,
                             SafeRegion& region) const override {
    const SafeRegion again = sprung::find_region(geometry_, element, request);
    if (again.broken || !std::isfinite(again.distance)) return;
    region.point = again.point;
    region.normal = again.normal;
    region.weights = again.weights;
  }

  [[nodiscard]] bool is_round() const override {
    return !std::is_same_v<Geometry, BoxGeometry> && !std::is_same_v<Geometry, HalfSpaceGeometry>;
  }

  [[nodiscard]] bool touches(const ElementCorners& element, double tolerance) const override {
    return !(separation(geometry_, element, box_around(element, tolerance)).gap > tolerance);
  }

  [[nodiscard]] bool contains(const Vector3& p) const override { return surface_point(geometry_, p).distance < 0.0; }

  [[nodiscard]] Box3 bounds() const override { return sprung::bounds(geometry_); }

  [[nodiscard]] double magnitude() const override {
    if constexpr (std::is_same_v<Geometry, HalfSpaceGeometry>) {
      return std::abs(geometry_.offset);
    } else {
      return bounds().max().maxCoeff();
    }
  }

  [[nodiscard]] double rounding(const Vector3& p) const override { return 1e-14 * (magnitude() + p.cwiseAbs().maxCoeff()); }

 private:
  Geometry geometry_;
};

}  // namespace sprung
