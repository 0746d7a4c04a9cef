// The directions in which contact constrains particles.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

class ConstrainedDirections {
 public:
  /// Removes all constraints, for this number of particles.
  void clear(Index particles) { projections_.assign(static_cast<std::size_t>(particles), Matrix3::Zero()); }

  /// Constrains a particle along `direction`, of any length. A direction within 30 degrees of those already constrained is
  /// ignored: several contacts with a round surface would otherwise fix the particle.
  void add(Index particle, const Vector3& direction) {
    constexpr double kAnother = 0.5;  // sine of 30 degrees
    Matrix3& constrained = projections_[static_cast<std::size_t>(particle)];
    const Vector3 another = direction - constrained * direction;
    if (another.norm() > kAnother * direction.norm()) constrained += another.normalized() * another.normalized().transpose();
  }

  /// The projection onto the constrained directions of a particle.
  [[nodiscard]] const Matrix3& projection(Index particle) const { return projections_[static_cast<std::size_t>(particle)]; }

 private:
  std::vector<Matrix3> projections_;
};

}  // namespace sprung
