// Makes a region of the triangles that it is shown.
#pragma once

#include "collision/safe_regions/triangle_separating_plane.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sprung {

class SafeRegionBuilder {
 public:
  /// Empties the region. The region keeps a reference to element, request and region.
  SafeRegionBuilder(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region);

  /// Makes the region keep off the triangle, if it does not yet.
  void meet(const TriangleCorners& corners);

  /// Takes the triangle as the nearest so far, if it is; where nearest points were before, they are looked for first.
  void look_at(Index triangle, const TriangleCorners& corners, const PairPlace& last = {});

  /// No triangle whose box is nearer than this [m] to the element's is to be left out, those aside that were looked at.
  void keep_clear(double distance) { clear_ = std::min(clear_, distance); }
  [[nodiscard]] double clear() const { return clear_; }

  /// Once all triangles were looked at or are clear: lets the region fill what is clear, if none was looked at and that holds all
  /// that was asked for.
  bool grow_clear();

  /// Tells how near the obstacle may be.
  void finish();

  /// What lies wholly below this along the nearest pair's normal is no nearer, but for rounding.
  [[nodiscard]] double nearest_limit() const { return nearest_lowest_ - (1.0 - kSameDistance) * region_.distance; }

  [[nodiscard]] const Box3& box() const { return region_.box; }
  [[nodiscard]] const Box3& element_box() const { return element_box_; }
  [[nodiscard]] int plane_count() const { return region_.plane_count; }
  [[nodiscard]] const Vector3& normal(int plane) const { return region_.planes[static_cast<std::size_t>(plane)].normal; }
  /// What lies wholly below this is ruled out by the plane already.
  [[nodiscard]] double limit(int plane) const { return limits_[static_cast<std::size_t>(plane)]; }

 private:
  // Neighbours share the nearest point on an edge or a corner: rounding is not to make one of them nearer.
  static constexpr double kSameDistance = 0x1p-30;

  [[nodiscard]] bool may_be_nearer(const TriangleCorners& corners) const;
  [[nodiscard]] bool is_beyond(const Vector3& normal, const Vector3& origin, const std::array<Vector3, 3>& points) const;
  [[nodiscard]] bool ruled_out(const TriangleCorners& corners) const;
  [[nodiscard]] bool shrink_past(const TriangleCorners& corners);
  void separate(const TriangleCorners& corners);
  bool separate_by_face(const TriangleCorners& corners);
  void keep_above(const TriangleCorners& corners, const TriangleSeparatingPlane& found);
  void keep_still(const TriangleCorners& corners, double distance);
  [[nodiscard]] double lowest(const Vector3& normal) const;

  const ElementCorners& element_;
  const SafeRegionRequest& request_;
  SafeRegion& region_;
  Box3 element_box_;
  Vector3 element_face_ = Vector3::Zero();
  std::array<double, SafeRegion::kMostPlanes> limits_{};
  double clear_ = std::numeric_limits<double>::infinity();
  double nearest_lowest_ = 0.0;  ///< of the element, along the normal at its nearest point
};

}  // namespace sprung
