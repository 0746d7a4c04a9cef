// Symmetric 3 x 3 matrices stored as six numbers, for solvers that invert one per particle.
#pragma once

#include "base/types.h"

namespace sprung {

struct SymmetricMatrix3 {
  double xx = 0.0;
  double xy = 0.0;
  double xz = 0.0;
  double yy = 0.0;
  double yz = 0.0;
  double zz = 0.0;

  SymmetricMatrix3& operator+=(const SymmetricMatrix3& other) {
    xx += other.xx, xy += other.xy, xz += other.xz, yy += other.yy, yz += other.yz, zz += other.zz;
    return *this;
  }

  [[nodiscard]] Vector3 operator*(const Vector3& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(), xz * v.x() + yz * v.y() + zz * v.z()};
  }

  /// Requires a regular matrix.
  [[nodiscard]] SymmetricMatrix3 inverse() const {
    const double a = yy * zz - yz * yz;
    const double b = xz * yz - xy * zz;
    const double c = xy * yz - xz * yy;
    const double scale = 1.0 / (xx * a + xy * b + xz * c);
    return {a * scale, b * scale, c * scale, (xx * zz - xz * xz) * scale, (xy * xz - xx * yz) * scale, (xx * yy - xy * xy) * scale};
  }

  [[nodiscard]] Matrix3 matrix() const { return Matrix3{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}; }

  /// a I + b n n^T
  [[nodiscard]] static SymmetricMatrix3 along(double a, double b, const Vector3& n) {
    const Vector3 bn = b * n;
    return {a + bn.x() * n.x(), bn.x() * n.y(), bn.x() * n.z(), a + bn.y() * n.y(), bn.y() * n.z(), a + bn.z() * n.z()};
  }
};

/// A B C; the caller knows that the product is symmetric.
[[nodiscard]] inline SymmetricMatrix3 symmetric_product(const SymmetricMatrix3& a, const SymmetricMatrix3& b,
                                                        const SymmetricMatrix3& c) {
  const Vector3 x = b * Vector3(c.xx, c.xy, c.xz);
  const Vector3 y = b * Vector3(c.xy, c.yy, c.yz);
  const Vector3 z = b * Vector3(c.xz, c.yz, c.zz);
  return {a.xx * x.x() + a.xy * x.y() + a.xz * x.z(), a.xx * y.x() + a.xy * y.y() + a.xz * y.z(),
          a.xx * z.x() + a.xy * z.y() + a.xz * z.z(), a.xy * y.x() + a.yy * y.y() + a.yz * y.z(),
          a.xy * z.x() + a.yy * z.y() + a.yz * z.z(), a.xz * z.x() + a.yz * z.y() + a.zz * z.z()};
}

}  // namespace sprung
