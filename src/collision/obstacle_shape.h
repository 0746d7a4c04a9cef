// What contact asks of a shape, in the shape's own frame. One implementation for meshes (FCL's tree, our leaves), one for
// primitives (exact signed distances).
#pragma once

#include "collision/obstacle.h"

#include <memory>
#include <optional>

namespace sprung {

/// The surface near a particle.
struct SurfacePoint {
  Vector3 point;          ///< nearest point of the surface [m]
  Vector3 normal;         ///< unit length, towards the free side: outward, or for an open mesh towards the particle
  double distance = 0.0;  ///< [m] along the normal; negative inside a closed shape
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

  /// The surface nearest to p, if nearer than `radius` [m] or, for primitives, if p is inside. Deep inside a closed mesh (farther
  /// than radius) nothing is found: use `contains`.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest(const Vector3& p, double radius) const = 0;

  /// The first crossing of the path from a to b. A path that starts outside and meets the surface is never missed, edges and
  /// vertices between triangles included.
  [[nodiscard]] virtual std::optional<Crossing> first_crossing(const Vector3& a, const Vector3& b) const = 0;

  /// Whether p is inside; always false for open meshes.
  [[nodiscard]] virtual bool contains(const Vector3& p) const = 0;
};

/// Throws InputError for a mesh without triangles or sizes that are not positive.
[[nodiscard]] std::unique_ptr<ObstacleShape> make_shape(const ObstacleGeometry& geometry);

}  // namespace sprung
