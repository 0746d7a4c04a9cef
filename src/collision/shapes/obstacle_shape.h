// Interface of an obstacle's shape for contact, in the shape's own frame. Implementations: triangle meshes (FCL's tree with own
// leaves) and primitives (exact signed distances).
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"
#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle.h"

#include <array>
#include <memory>
#include <optional>

namespace sprung {

/// Its corners at an interval's begin and end [m].
struct MovedTriangle {
  std::array<Vector3, 3> before;
  std::array<Vector3, 3> after;
};

/// The point of the surface nearest to a particle.
struct SurfacePoint {
  Vector3 point;          ///< nearest point of the surface [m]
  Vector3 normal;         ///< unit length: outward, or for an open mesh towards the particle
  double distance = 0.0;  ///< [m] along the normal; negative inside a closed shape
};

/// Result of the last search for the surface near a particle; the next search starts here.
struct SurfaceMemory {
  Index triangle = kNone;
  Vector3 query_point = Vector3::Zero();  ///< [m]
  double clear = 0.0;                     ///< lower bound of the distance between surface and `query_point` [m]
};

template <Same<SurfaceMemory> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.triangle, m.query_point, m.clear);
}

/// An element that moved with an obstacle.
struct MovedElement {
  ElementCorners corners;
  double distance = 0.0;  ///< from the surface that moved it [m]; 0 for a rigid shape
};

/// The first intersection of a straight path with the surface.
struct Crossing {
  double fraction = 0.0;  ///< of the path, in [0, 1]
  Vector3 point;
  Vector3 normal;  ///< unit length, on the side where the path comes from
};

/// Const and thread-safe. A shape that deforms is the one of an interval: queries refer to its end unless stated otherwise.
class ObstacleShape {
 public:
  virtual ~ObstacleShape() = default;

  /// Whether the surface ever moves within its own frame.
  [[nodiscard]] virtual bool deforms() const { return false; }

  /// The shape in the interval from `begin` to `end` [s]. Null if the shape does not deform: it then is the same at all times.
  [[nodiscard]] virtual std::shared_ptr<const ObstacleShape> in_interval(double /*begin*/, double /*end*/) const { return nullptr; }

  /// Largest displacement [m] of a surface point in the interval, in the shape's frame.
  [[nodiscard]] virtual double largest_displacement() const { return 0.0; }

  /// Displacement [m] in the interval of the surface point that is nearest to p at the begin of the interval, in the shape's
  /// frame.
  [[nodiscard]] virtual Vector3 displacement(const Vector3& /*p*/) const { return Vector3::Zero(); }

  /// Moves an element from the begin of the interval to its end together with the nearest triangle. It keeps its height above the
  /// triangle. Returns nothing if the element touches the surface, if no surface is near, or if another triangle comes between.
  [[nodiscard]] virtual std::optional<MovedElement> moved_element(const ElementCorners& element) const { return {{element}}; }

  /// The triangle nearest to p at the begin of the interval, in the shape's frame. Returns nothing if the shape does not deform.
  [[nodiscard]] virtual std::optional<MovedTriangle> moved_triangle(const Vector3& /*p*/) const { return std::nullopt; }

  /// Displacement [m] from t to t_end of the surface point that is nearest to p at the end of the interval, in the shape's frame.
  [[nodiscard]] virtual Vector3 displacement(const Vector3& /*p*/, double /*t*/, double /*t_end*/) const { return Vector3::Zero(); }

  /// The surface point nearest to p, if nearer than `radius` [m] or if p is inside a primitive. Returns nothing if p is inside a
  /// closed mesh and farther than `radius` from its surface: use contains(). If p is on the surface, the normal is that of a face
  /// at p.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const = 0;

  /// Like nearest(), but reuses the result of the last search. If p moved by less than `tolerance` [m], the result may be on the
  /// same triangle although another one is nearer.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest_cached(const Vector3& p, double radius, double /*tolerance*/,
                                                                   SurfaceMemory& /*memory*/) const {
    return nearest(p, radius);
  }

  /// The first crossing of the path from a to b. A path that starts outside and crosses the surface is never missed, not even at
  /// edges and vertices. On closed shapes only entering counts, so that a particle inside can leave; a path that starts on the
  /// surface and enters is a crossing. A path that starts on an open mesh does not cross it there. If a == b there is no crossing.
  [[nodiscard]] virtual std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const = 0;

  /// Builds the safe region of an element. On entry `region` is the result of the element's previous search.
  virtual void find_region(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) const = 0;

  /// Updates the closest points of the region for the element at the begin of the interval. On a mesh, if `fresh`, the closest
  /// triangle stays the same. The rest of the region does not change. The closest points do not change either if element and shape
  /// touch, or if a primitive is not within `reach`.
  virtual void update_closest_points(const ElementCorners& element, const SafeRegionRequest& request, bool fresh,
                                     SafeRegion& region) const = 0;

  /// Whether the surface curves within the size of an element.
  [[nodiscard]] virtual bool is_round() const { return false; }

  /// Advances a region from the end of the previous interval to the end of this one: it moves with a surface that deforms. Returns
  /// false if the region belongs to another time and cannot be advanced.
  virtual bool advance_region(SafeRegion& /*region*/) const { return true; }

  /// Whether the element is within `tolerance` [m] of the surface. The result is unspecified for an element wholly inside.
  /// Crossings of meshes are decided exactly.
  [[nodiscard]] virtual bool touches(const ElementCorners& element, double tolerance) const = 0;

  /// Whether p is inside; always false for open meshes.
  [[nodiscard]] virtual bool contains(const Vector3& p) const = 0;

  /// A box that contains the shape throughout the interval [m]; infinite for a half-space.
  [[nodiscard]] virtual Box3 bounds() const = 0;

  /// The largest coordinate of the shape at any time [m]; for a half-space its offset.
  [[nodiscard]] virtual double magnitude() const = 0;

  /// Upper bound [m] of the rounding error of distances measured from p.
  [[nodiscard]] virtual double rounding(const Vector3& p) const = 0;
};

/// Throws InputError, which names every problem: a mesh without triangles, positions that are not finite, indices out of range,
/// frames that do not match, sizes that are not positive.
[[nodiscard]] std::unique_ptr<ObstacleShape> make_shape(const ObstacleGeometry& geometry);

}  // namespace sprung
