// Builds a safe region from triangles.
#pragma once

#include "collision/safe_regions/safe_region.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sprung {

class SafeRegionBuilder {
 public:
  /// Resets the region. The builder keeps references to all three arguments.
  SafeRegionBuilder(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region);

  /// Excludes the triangle from the region, unless it is excluded already.
  void exclude(const TriangleCorners& corners);

  /// Makes the triangle the nearest one, if it is. The closest points are searched on the features `last` first.
  void consider(Index triangle, const TriangleCorners& corners, const FeaturePair& last = {});

  /// Limits the clear distance to `distance` [m]. Each triangle whose box is nearer to the box of the element has to be considered.
  void limit_clear_distance(double distance) { clear_distance_ = std::min(clear_distance_, distance); }
  [[nodiscard]] double clear_distance() const { return clear_distance_; }

  /// Grows the box to the clear distance if no triangle is within it. Returns whether it did; it does not if the requested box is
  /// larger. Call it after all triangles within the clear distance were considered.
  bool grow_to_clear_distance();

  /// Sets `clear` of the region, and removes the planes of a broken region.
  void finish();

  /// A triangle wholly below this height along the nearest pair's normal is not nearer, apart from rounding.
  [[nodiscard]] double nearest_limit() const { return nearest_lowest_ - (1.0 - kDistanceTolerance) * region_.distance; }

  [[nodiscard]] const Box3& box() const { return region_.box; }
  [[nodiscard]] const Box3& element_box() const { return element_box_; }
  [[nodiscard]] int plane_count() const { return region_.plane_count; }
  [[nodiscard]] const Vector3& normal(int plane) const { return region_.planes[static_cast<std::size_t>(plane)].normal; }
  /// A triangle wholly below this height along the plane's normal is excluded already.
  [[nodiscard]] double limit(int plane) const { return limits_[static_cast<std::size_t>(plane)]; }

 private:
  // Neighbouring triangles share closest points on edges and corners. This relative tolerance makes them equally near despite
  // rounding.
  static constexpr double kDistanceTolerance = 0x1p-30;

  [[nodiscard]] bool may_be_nearer(const TriangleCorners& corners) const;
  [[nodiscard]] bool is_beyond(const Vector3& normal, const Vector3& origin, const std::array<Vector3, 3>& points) const;
  [[nodiscard]] bool is_excluded(const TriangleCorners& corners) const;
  [[nodiscard]] bool shrink_past(const TriangleCorners& corners);
  void separate(const TriangleCorners& corners);
  bool separate_by_face(const TriangleCorners& corners);
  void add_plane(const TriangleCorners& corners, const TriangleSeparatingPlane& found);
  void limit_motion(const TriangleCorners& corners, double distance);
  [[nodiscard]] double lowest(const Vector3& normal) const;

  const ElementCorners& element_;
  const SafeRegionRequest& request_;
  SafeRegion& region_;
  Box3 element_box_;
  Vector3 element_face_ = Vector3::Zero();
  std::array<double, SafeRegion::kMostPlanes> limits_{};
  double clear_distance_ = std::numeric_limits<double>::infinity();
  double nearest_lowest_ = 0.0;  ///< of the element, along the normal at the closest point
};

}  // namespace sprung
