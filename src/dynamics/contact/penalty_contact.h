// Penalty contact, the OpenGL page's f_coll in f = f_g + f_coll + sum of spring forces.
#pragma once

#include "collision/obstacles/environment.h"
#include "dynamics/forces/force.h"
#include "network/spring_network.h"

namespace sprung {

/// A particle deeper than its gap by p feels k p - c v_n along the surface's normal (never a pull), and Coulomb friction of at most
/// friction times that, and at most what stops it within a step.
class PenaltyContact final : public Force {
 public:
  /// `stiffness` k [N/m] > 0, `damping` c [N s/m] >= 0, `dt` [s] the step. Keeps references to the network and to the environment.
  PenaltyContact(const SpringNetwork& network, Environment& environment, double stiffness, double damping, double dt);

  /// Obstacles go where they are at `time`: the environment's interval becomes (time, time).
  /// Steps are of length `dt` [s] from now on.
  void set_step(double dt) { dt_ = dt; }

  void prepare(double time) override;
  void add(const Kinematics& at, Points& forces) const override;

  /// As if the surface were the plane that it is nearest, and without what a push does to the friction that it allows: that is not
  /// symmetric.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// How many particles are nearer to an obstacle than their gap.
  [[nodiscard]] Index contact_count(const Points& positions) const;

 private:
  struct Touch;
  [[nodiscard]] Touch touch(const Contact& contact, const Kinematics& at) const;

  const SpringNetwork& network_;
  Environment& environment_;
  double stiffness_;
  double damping_;
  double dt_;
  Scalars thickness_;
};

}  // namespace sprung
