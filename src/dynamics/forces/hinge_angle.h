// The angle of a hinge and its gradient. Internal to dynamics/forces.
#pragma once

#include "network/model/face_bends.h"

#include <array>

namespace sprung {

/// A hinge at some positions. With the edge e = b - a and the doubled areas n = e x (c - a) of the triangle on the left and
/// m = (d - a) x e of the other, the angle is theta = atan2((m x n) . e / |e|, n . m). Its gradient is |e| n / n^2 at c, |e| m /
/// m^2 at d, and minus their shares at a and b (Bridson, Marino and Fedkiw 2003).
///
/// phi is theta minus the angle at rest, wrapped to [-pi, pi], times a factor f of each triangle. f = r^2 (3 - 2 r) of the area
/// divided by that at rest, r, and 1 for r > 1: with it, no triangle that shrinks as the mesh crumples makes the gradient of its
/// height longer than 9/8 of that at rest, so that steps stay stable, and forces end where triangles collapse.
class HingeAngle {
 public:
  HingeAngle(const Hinges& hinges, Index hinge, const Points& x);

  [[nodiscard]] double deviation() const;  ///< phi [rad]

  /// d phi / d x [1/m] of the particles of the hinge. Zero where a triangle has no area.
  [[nodiscard]] std::array<Vector3, 4> gradient() const;

 private:
  struct Triangle {
    Vector3 normal = Vector3::Zero();
    double factor = 1.0;    ///< f
    double per_area = 0.0;  ///< f / the doubled area [1/m^2]
    double slope = 0.0;     ///< of f by the doubled area [1/m^2]
  };

  static Triangle triangle_of(const Vector3& doubled_area, double rest_area);
  [[nodiscard]] double angle_from(double rest_angle) const;

  std::array<Vector3, 4> x_;
  Vector3 edge_;
  double length_;  ///< of the edge [m]
  Triangle left_;
  Triangle right_;
  bool has_angle_;
  double angle_from_rest_;  ///< theta minus the angle at rest [rad]
};

}  // namespace sprung
