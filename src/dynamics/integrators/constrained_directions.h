// The directions in which contact constrains particles.
#pragma once

#include "base/types.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace sprung {

/// An obstacle that pushes a particle.
struct Support {
  Vector3 normal = Vector3::Zero();
  Vector3 displacement = Vector3::Zero();  ///< of the touched surface in the step [m]
  double static_friction = 0.0;
  double friction = 0.0;
};

class ConstrainedDirections {
 public:
  /// Removes all constraints, for this number of particles.
  void clear(Index particles) { constraints_.assign(static_cast<std::size_t>(particles), {}); }

  /// Constrains a particle along `direction`, of any length. A direction within 30 degrees of those already constrained is
  /// ignored: several contacts with a round surface would otherwise fix the particle. Returns whether it was not.
  bool add(Index particle, const Vector3& direction) {
    constexpr double kAnother = 0.5;  // sine of 30 degrees
    Matrix3& constrained = constraints_[static_cast<std::size_t>(particle)].projection;
    const Vector3 another = direction - constrained * direction;
    if (!(another.norm() > kAnother * direction.norm())) return false;
    constrained += another.normalized() * another.normalized().transpose();
    return true;
  }

  /// Constrains a particle along the support's normal.
  void add(Index particle, const Support& support) {
    if (!add(particle, support.normal)) return;
    Constraint& constraint = constraints_[static_cast<std::size_t>(particle)];
    constraint.supports[constraint.count++] = support;
  }

  /// The projection onto the constrained directions of a particle.
  [[nodiscard]] const Matrix3& projection(Index particle) const {
    return constraints_[static_cast<std::size_t>(particle)].projection;
  }

  /// The obstacles that push a particle: at most three, whose normals differ by more than 30 degrees.
  [[nodiscard]] std::span<const Support> supports(Index particle) const {
    const Constraint& constraint = constraints_[static_cast<std::size_t>(particle)];
    return {constraint.supports.data(), constraint.count};
  }

 private:
  struct Constraint {
    Matrix3 projection = Matrix3::Zero();
    std::array<Support, 3> supports{};
    std::size_t count = 0;
  };

  std::vector<Constraint> constraints_;
};

}  // namespace sprung
