// What contact asks of a shape, in the shape's own frame. One implementation for meshes (FCL's tree, our leaves), one for
// primitives (exact signed distances).
#pragma once

#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/moved_triangle.h"
#include "collision/shapes/obstacle.h"

#include <memory>
#include <optional>

namespace sprung {

/// The surface near a particle.
struct SurfacePoint {
  Vector3 point;          ///< nearest point of the surface [m]
  Vector3 normal;         ///< unit length, towards the free side: outward, or for an open mesh towards the particle
  double distance = 0.0;  ///< [m] along the normal; negative inside a closed shape
};

/// What the search for the surface near a particle found last, where the next one may begin.
struct SurfaceMemory {
  Index triangle = kNone;
  Vector3 asked_at = Vector3::Zero();  ///< [m]
  double clear = 0.0;                  ///< nothing of the surface is nearer to `asked_at` than this [m]
};

/// An element that an obstacle carries.
struct MovedElement {
  ElementCorners corners;
  double distance = 0.0;  ///< from what carries it [m]; 0 for a shape that carries all alike
};

/// Where a straight path meets the surface for the first time.
struct Crossing {
  double fraction = 0.0;  ///< of the path, in [0, 1]
  Vector3 point;
  Vector3 normal;  ///< unit length, against the path
};

class ObstacleShape {
 public:
  virtual ~ObstacleShape() = default;

  /// Whether the surface ever moves within its own frame.
  [[nodiscard]] virtual bool deforms() const { return false; }

  /// The step from time t to t_end [s]: what is asked below is answered for its end. Not thread-safe.
  virtual void set_interval(double /*t*/, double /*t_end*/) {}

  /// The farthest that a point of the surface moves in the interval, in the shape's frame [m].
  [[nodiscard]] virtual double largest_displacement() const { return 0.0; }

  /// How far the point of the surface that is nearest to p at the interval's begin moves in it, in the shape's frame [m].
  [[nodiscard]] virtual Vector3 displacement(const Vector3& /*p*/) const { return Vector3::Zero(); }

  /// Where a surface that deforms takes an element along from the interval's begin: as high above the triangle that is nearest to
  /// it, in the triangle's own axes, and higher by `lift`, a part of how far the surface goes at most. Nothing where another part
  /// of the surface comes between, or where none is near.
  [[nodiscard]] virtual std::optional<MovedElement> moved_element(const ElementCorners& element, double /*lift*/) const {
    return {{element}};
  }

  /// The triangle that is nearest to p at the interval's begin, in the shape's frame; nothing where the surface does not deform.
  [[nodiscard]] virtual std::optional<MovedTriangle> moved_triangle(const Vector3& /*p*/) const { return std::nullopt; }

  /// How far the point of the surface that is nearest to p at the interval's end moves from time t to t_end, likewise.
  [[nodiscard]] virtual Vector3 displacement(const Vector3& /*p*/, double /*t*/, double /*t_end*/) const { return Vector3::Zero(); }

  /// The surface nearest to p, if nearer than `radius` [m] or, for primitives, if p is inside. Deep inside a closed mesh (farther
  /// than radius) nothing is found: use `contains`. Where p is on the surface the normal is that of the face found there.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const = 0;

  /// The same, begun with what was found last: after a motion of less than `same` [m] the surface found may be that of the same
  /// triangle.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest_again(const Vector3& p, double radius, double /*same*/,
                                                                  SurfaceMemory& /*memory*/) const {
    return nearest(p, radius);
  }

  /// The first crossing of the path from a to b. A path that starts outside and meets the surface is never missed, edges and
  /// vertices between triangles included. Of closed shapes only the way in counts, so that what was caught inside can leave; a path
  /// that begins on the surface crosses it when it goes in. A path that begins on an open mesh has no side and does not cross it
  /// there. No path, no crossing: a == b.
  [[nodiscard]] virtual std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const = 0;

  /// Makes the region of an element that the shape does not cross; `region` comes as it was left by the element's last search.
  virtual void find_region(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) const = 0;

  /// Finds the nearest points of the region's element again, where it is when the interval begins: of a mesh, while it is `fresh`,
  /// those on the same triangle. The rest of the region stays, as do the nearest points where element and shape touch or a
  /// primitive is not within `reach`.
  virtual void update_closest_points(const ElementCorners& element, const SafeRegionRequest& request, bool fresh,
                                     SafeRegion& region) const = 0;

  /// Makes a region that was for the end of the interval before one for the end of this: where the surface deforms, it takes the
  /// region along. False for a region of another time, which cannot be taken along.
  virtual bool advance_region(SafeRegion& /*region*/) const { return true; }

  /// Whether the element comes within `tolerance` [m] of the surface; an element that is wholly inside need not tell. Crossings of
  /// meshes are judged exactly.
  [[nodiscard]] virtual bool touches(const ElementCorners& element, double tolerance) const = 0;

  /// Whether p is inside; always false for open meshes.
  [[nodiscard]] virtual bool contains(const Vector3& p) const = 0;

  /// A box around the shape throughout the interval [m]; infinite for a half-space.
  [[nodiscard]] virtual Box3 bounds() const = 0;

  /// The largest coordinate on the shape at any time [m]; of a half-space, whose coordinates have no end, its offset.
  [[nodiscard]] virtual double magnitude() const = 0;

  /// What rounding may do to distances measured from p [m].
  [[nodiscard]] virtual double rounding(const Vector3& p) const = 0;
};

/// Throws InputError, naming every problem, for a mesh without triangles, with positions that are not finite or indices out of
/// range, for frames that do not fit their triangles or each other, and for sizes that are not positive.
[[nodiscard]] std::unique_ptr<ObstacleShape> make_shape(const ObstacleGeometry& geometry);

}  // namespace sprung
