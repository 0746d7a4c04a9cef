#include "dynamics/forces/surface_air_kernel.h"

#include "base/machine/kernel.h"
#include "base/machine/simd.h"

#include <algorithm>

namespace sprung {
namespace {

using Faces = std::array<const AirElement*, kSimdWidth>;

[[gnu::always_inline]] inline void gather(const double* points, const Faces& faces, std::size_t corner, Vector3x4& to) {
  const double* const a = points + 3 * faces[0]->ends[corner];
  const double* const b = points + 3 * faces[1]->ends[corner];
  const double* const c = points + 3 * faces[2]->ends[corner];
  const double* const d = points + 3 * faces[3]->ends[corner];
  to.x = Double4{a[0], b[0], c[0], d[0]};
  to.y = Double4{a[1], b[1], c[1], d[1]};
  to.z = Double4{a[2], b[2], c[2], d[2]};
}

[[gnu::always_inline]] inline void gather_mean(const double* points, const Faces& faces, Vector3x4& to) {
  Vector3x4 second{};
  Vector3x4 third{};
  gather(points, faces, 0, to);
  gather(points, faces, 1, second);
  gather(points, faces, 2, third);
  to.x = (to.x + second.x + third.x) / 3.0;
  to.y = (to.y + second.y + third.y) / 3.0;
  to.z = (to.z + second.z + third.z) / 3.0;
}

/// Normals with a length of twice the area [m^2].
[[gnu::always_inline]] inline void gather_area_normals(const double* points, const Faces& faces, Vector3x4& to) {
  Vector3x4 first{};
  Vector3x4 second{};
  Vector3x4 third{};
  gather(points, faces, 0, first);
  gather(points, faces, 1, second);
  gather(points, faces, 2, third);
  Vector3x4 a{};
  Vector3x4 b{};
  subtract(second, first, a);
  subtract(third, first, b);
  to.x = a.y * b.z - a.z * b.y;
  to.y = a.z * b.x - a.x * b.z;
  to.z = a.x * b.y - a.y * b.x;
}

[[gnu::always_inline]] inline void find_length(const Vector3x4& of, Double4& length) {
  dot(of, of, length);
  square_root(length);
}

/// The force by speed and area [kg/(m^2 s)], as `resistance` in surface_air_force.cpp.
[[gnu::always_inline]] inline void find_secant(bool quadratic, double coefficient, double low_speed, const Double4& speed,
                                               const Double4& limit, Double4& secant) {
  secant = Double4{} + coefficient;
  if (!quadratic) return;
  if (low_speed > 0.0) {
    const Double4 end = 0.5 * (limit / coefficient - low_speed);
    const Double4 from = end > 0.0 ? end : Double4{};
    const Double4 bounded = limit - coefficient * from * from / speed;
    secant = speed <= from ? coefficient * (speed + low_speed) : bounded;
    return;
  }
  const Double4 rate = 2.0 * coefficient * speed;
  const Double4 linear = limit * (1.0 - 0.5 * limit / rate);
  secant = rate <= limit ? coefficient * speed : linear;
}

}  // namespace

SPRUNG_KERNEL
void find_face_forces(const AirElement* faces, Index count, const FaceAir& air, double* thirds) {
  for (Index first = 0; first < count; first += kSimdWidth) {
    const Index here = std::min(kSimdWidth, count - first);
    Faces four{};
    for (Index lane = 0; lane < kSimdWidth; ++lane) four[lane] = faces + first + std::min(lane, here - 1);
    const Double4 rate_share{four[0]->rate_share, four[1]->rate_share, four[2]->rate_share, four[3]->rate_share};
    Vector3x4 normal{};
    gather_area_normals(air.positions, four, normal);
    Double4 length{};
    find_length(normal, length);
    const Double4 area = 0.5 * length;
    normal.x /= length;
    normal.y /= length;
    normal.z /= length;
    Vector3x4 velocity{};
    gather_mean(air.velocities, four, velocity);
    Vector3x4 along{};
    if (air.air != nullptr) {
      gather_mean(air.air, four, along);
    } else {
      set_all_lanes(air.mean, along);
    }
    subtract(along, velocity, along);
    Double4 speed_across{};
    dot(normal, along, speed_across);
    Vector3x4 across{};
    across.x = speed_across * normal.x;
    across.y = speed_across * normal.y;
    across.z = speed_across * normal.z;
    subtract(along, across, along);
    Double4 speed_along{};
    find_length(across, speed_across);
    find_length(along, speed_along);
    const Double4 of_step = kRateOfStep / (air.step * area * rate_share);
    const Double4 expected = Double4{} + air.expected;
    const Double4 limit = expected < of_step ? of_step : expected;
    Double4 on_normal{};
    Double4 on_tangent{};
    find_secant(air.quadratic, air.normal, air.low_speed, speed_across, limit, on_normal);
    find_secant(air.quadratic, air.tangential, 0.0, speed_along, limit, on_tangent);
    const Double4 x = area * (on_normal * across.x + on_tangent * along.x) / 3.0;
    const Double4 y = area * (on_normal * across.y + on_tangent * along.y) / 3.0;
    const Double4 z = area * (on_normal * across.z + on_tangent * along.z) / 3.0;
    for (Index lane = 0; lane < here; ++lane) {
      double* const to = thirds + 3 * (first + lane);
      const bool collapsed = length[lane] == 0.0;
      to[0] = collapsed ? 0.0 : x[lane];
      to[1] = collapsed ? 0.0 : y[lane];
      to[2] = collapsed ? 0.0 : z[lane];
    }
  }
}

}  // namespace sprung
