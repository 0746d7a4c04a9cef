// The force of a hand that pulls a body.
#pragma once

#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Pulls a particle, and its neighbours in the body, towards a target by damped springs: the neighbours keep their offsets to it.
///
/// Each spring acts as if it was integrated implicitly for its particle alone, F = -(k u + c v) / (1 + c dt / m + k dt^2 / m) with
/// the displacement u from the target and k = m' / s^2, c = 2 m' / s for the particle's share m' of the body's mass (critical
/// damping, with a time of s = 0.1 s), and c >= 2 k dt, which explicit Euler needs. The displacement and velocity of a particle
/// then change by less than themselves in a step, so no pull makes a step unstable.
///
/// Const members may be called from several threads at the same time. Call set_target() between steps. The force costs a few
/// operations per attached particle.
class PullForce final : public Force {
 public:
  /// Attaches to particles of the body at `positions` [m] that are within a twentieth of the body's extent of `particle`. Pinned
  /// particles are left out. `step` is the longest step [s] that follows. The first target is the position of `particle`.
  PullForce(const SpringNetwork& network, const Points& positions, Index particle, double step);

  /// Sets the position that the particle is pulled to [m].
  void set_target(const Vector3& target) { target_ = target; }
  [[nodiscard]] const Vector3& target() const { return target_; }

  /// The force on the body [N] at these positions [m] and velocities [m/s].
  [[nodiscard]] Vector3 total(const Points& x, const Points& v) const;

  [[nodiscard]] std::optional<std::vector<Index>> touched() const override;
  void add(const Kinematics& at, Points& forces) const override;
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

 private:
  struct Grip {
    Index particle;
    Vector3 offset;    ///< from the target [m]
    double stiffness;  ///< [N/m], as above with its denominator
    double damping;    ///< [N s/m]
  };
  [[nodiscard]] Vector3 force_on(const Grip& grip, const Points& x, const Points& v) const;

  std::vector<Grip> grips_;
  Vector3 target_;
};

}  // namespace sprung
