#include "collision/primitives/primitive_shape.h"

namespace sprung {

std::optional<Crossing> first_crossing_of_convex(const std::function<SurfacePoint(const Vector3&)>& distance, double rounding,
                                                 const Vector3& a, const Vector3& b) {
  if (a == b) return std::nullopt;
  const Vector3 path = b - a;
  double fraction = 0.0;
  SurfacePoint surface = distance(a);
  if (surface.distance < -rounding) return std::nullopt;
  // Newton's method converges quadratically, except on a path that grazes the surface. There each step halves the rest, and 64
  // halvings are enough.
  for (int step = 0; step < 64 && surface.distance > rounding; ++step) {
    const double slope = surface.normal.dot(path);
    const double height = surface.distance - 0.5 * rounding;
    if (height + slope * (1.0 - fraction) > 0.0) return std::nullopt;
    fraction = std::min(fraction - height / slope, 1.0);
    surface = distance(a + fraction * path);
  }
  if (fraction == 0.0 && surface.normal.dot(path) >= 0.0) return std::nullopt;
  return Crossing{fraction, surface.point, surface.normal};
}

}  // namespace sprung
