// In which directions particles are kept from going.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

class ConstrainedDirections {
 public:
  /// Nothing holds any of so many particles.
  void clear(Index particles) { projections_.assign(static_cast<std::size_t>(particles), Matrix3::Zero()); }

  /// Holds a particle along this direction of any length too. One within 30 degrees of what those that are held span adds nothing:
  /// several contacts with what is round would hold it altogether.
  void add(Index particle, const Vector3& direction) {
    constexpr double kAnother = 0.5;  // sine of that
    Matrix3& held = projections_[static_cast<std::size_t>(particle)];
    const Vector3 another = direction - held * direction;
    if (another.norm() > kAnother * direction.norm()) held += another.normalized() * another.normalized().transpose();
  }

  /// Projects to all directions that the particle is held along.
  [[nodiscard]] const Matrix3& projection(Index particle) const { return projections_[static_cast<std::size_t>(particle)]; }

 private:
  std::vector<Matrix3> projections_;
};

}  // namespace sprung
