// The geometry of an angle bend: see bending_angle_force.h.
#pragma once

#include "base/types.h"
#include "network/model/spring_network.h"

#include <array>
#include <cmath>

namespace sprung {

/// f(bond) and its derivative: the gradient of f is `slope` times the bond.
struct Fullness {
  double value = 1.0;
  double slope = 0.0;  ///< [1/m^2]
};

[[nodiscard]] inline Fullness fullness_of(const Vector3& bond, double rest_length) {
  const double square = rest_length * rest_length;
  const double most = 4.0 * bond.squaredNorm();
  return most < square ? Fullness{most / square, 8.0 / square} : Fullness{};
}

struct Bend {
  Bend(const AngleBends& bends, Index element, const Points& x)
      : a(x.col(bends.middle[element]) - x.col(bends.before[element])),
        b(x.col(bends.after[element]) - x.col(bends.middle[element])),
        normal(a.cross(b)),
        sine(normal.norm()),
        full_a(fullness_of(a, bends.length_before[element])),
        full_b(fullness_of(b, bends.length_after[element])) {}

  [[nodiscard]] double angle() const { return std::atan2(sine, a.dot(b)); }
  [[nodiscard]] double fullness() const { return full_a.value * full_b.value; }
  [[nodiscard]] double energy(double stiffness) const { return 0.5 * stiffness * angle() * angle() * fullness(); }

  Vector3 a;
  Vector3 b;
  Vector3 normal;
  double sine;  ///< |a| |b| sin(angle)
  Fullness full_a;
  Fullness full_b;
};

/// The gradient of the angle at before, middle and after [1/m]. Requires a non-zero sine.
[[nodiscard]] inline std::array<Vector3, 3> turns(const Bend& bend) {
  const Vector3 before = (1.0 / (bend.sine * bend.a.squaredNorm())) * bend.normal.cross(bend.a);
  const Vector3 after = (1.0 / (bend.sine * bend.b.squaredNorm())) * bend.normal.cross(bend.b);
  return {before, -(before + after), after};
}

[[nodiscard]] inline std::array<Index, 3> particles_of(const AngleBends& bends, Index element) {
  return {bends.before[element], bends.middle[element], bends.after[element]};
}

}  // namespace sprung
