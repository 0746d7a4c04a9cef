// Safe region: a convex set around an element that excludes an obstacle, in the obstacle's own frame. While all corners of the
// element stay inside, so does their convex hull, and the element cannot cross the obstacle. Separating planes of an element and a
// triangle bound it.
#pragma once

#include "base/files/binary_archive.h"
#include "collision/core/half_space.h"
#include "geometry/queries/closest_pair.h"

#include <array>
#include <limits>

namespace sprung {

/// The corners of an element in the obstacle's frame.
using ElementCorners = Simplex;

/// Parameters of a safe region. All lengths [m], > 0.
struct SafeRegionRequest {
  double reach = 0.0;      ///< the box exceeds element and path by this on each side, unless the obstacle is nearer
  Box3 path{};             ///< bounds the targets of the corners; empty if unknown
  double gap = 0.0;        ///< contact gap of element and obstacle; a plane keeps at most half of it
  double clearance = 0.0;  ///< minimum distance of a plane from the obstacle, if the element is that far
  double exact = 0.0;      ///< below this distance the closest points are exact; may be 0
  bool at_end = false;     ///< the corners are those at the end of the obstacle's interval; else at its begin
};

/// The intersection of the box and the half-spaces. It contains the element and excludes the obstacle at the end of the interval.
/// If the corners are those at the begin of the interval and the surface deforms, the region is moved with the surface.
struct SafeRegion {
  static constexpr int kMostPlanes = 4;

  Box3 box{};
  std::array<HalfSpace, kMostPlanes> planes{};
  int plane_count = 0;
  double free_radius = std::numeric_limits<double>::infinity();  ///< no corner may move farther than this [m]
  bool broken = false;  ///< element and obstacle touch or cross, so the region excludes nothing

  double clear = 0.0;  ///< lower bound of the distance between obstacle and element [m]

  /// The closest points of element and obstacle; approximate if they are farther apart than `exact`. The distance is infinite if
  /// the obstacle is neither within `exact` of the element nor able to come within `reach` of it.
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  Vector3 point = Vector3::Zero();                            ///< on the obstacle
  Vector3 normal = Vector3::Zero();                           ///< from the obstacle to the element, unit length
  Vector3 weights = Vector3::Zero();                          ///< of the element's corners; their sum is 1
  Index triangle = kNone;                                     ///< of the obstacle; the next search starts here
  FeaturePair features{};                                     ///< that contain the closest points; the next search starts here

  // Only for a surface that deforms:
  double time = std::numeric_limits<double>::quiet_NaN();  ///< end of the interval that the region is valid for [s]
  Vector3 drift = Vector3::Zero();                         ///< displacement of the surface at `point` in that interval [m]
  double loss = 0.0;                                       ///< by how much each side has shrunk since the region was built [m]
  Vector3 triangle_weights = Vector3::Zero();              ///< of the triangle's corners at `point`; their sum is 1
};

template <Same<SafeRegion> S, class Visit>
void visit_members(S& r, const Visit& visit) {
  visit(r.plane_count);
  if (r.plane_count < 0 || r.plane_count > SafeRegion::kMostPlanes) throw BytesError();
  for (int k = 0; k < r.plane_count; ++k) visit(r.planes[static_cast<std::size_t>(k)]);
  visit(r.box, r.free_radius, r.broken, r.clear, r.distance, r.point, r.normal, r.weights, r.triangle, r.features, r.time, r.drift,
        r.loss, r.triangle_weights);
}

/// The box, smaller by `margin` [m] >= 0 on each side; empty if opposite sides pass each other.
[[nodiscard]] Box3 shrunk(const Box3& box, double margin);

/// The box around the element, `reach` [m] larger on each side.
[[nodiscard]] Box3 box_around(const ElementCorners& element, double reach);

/// The largest box that a region may have.
[[nodiscard]] Box3 requested_box(const ElementCorners& element, const SafeRegionRequest& request);

/// Distance [m] that a plane keeps from an obstacle at distance `gap` [m]. The element may use the rest of the gap. The result is
/// at most half of the contact gap, apart from the clearance, and never more than `gap`.
[[nodiscard]] double stand_off(double gap, const SafeRegionRequest& request);

/// Whether the gap [m] is within rounding of 0.
[[nodiscard]] bool is_touching(double gap, const SafeRegionRequest& request);

using TriangleCorners = std::array<Vector3, 3>;

/// The direction from the triangle to the element with the largest separation.
struct TriangleSeparatingPlane {
  Vector3 normal = Vector3::Zero();                       ///< unit length
  double gap = -std::numeric_limits<double>::infinity();  ///< lowest height of the element minus the triangle's highest [m]
};

[[nodiscard]] double lowest_along(const Vector3& normal, const ElementCorners& element);
[[nodiscard]] double highest_along(const Vector3& normal, const TriangleCorners& triangle);

/// Finds a separating plane. The direction between the closest points separates by their whole distance. If that distance is
/// within rounding of the coordinates, this direction is inaccurate. Then the face normals and the cross products of edges are
/// tried too. `pair` and `slack` come from closest_pair. If the gap is not positive, element and triangle cross or touch.
[[nodiscard]] TriangleSeparatingPlane separation(const ElementCorners& element, const TriangleCorners& triangle,
                                                 const ClosestPair& pair, double slack);

}  // namespace sprung
