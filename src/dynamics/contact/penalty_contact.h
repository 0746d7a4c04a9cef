// Penalty contact, the OpenGL page's f_coll in f = f_g + f_coll + sum of spring forces.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/contact/contact_force.h"
#include "network/model/spring_network.h"

namespace sprung {

/// A particle at depth p below its gap feels k p - c v_n along the surface's normal, never a pull. Coulomb friction is at most
/// friction times that force, and at most what stops the particle within a step.
class PenaltyContact final : public ContactForce {
 public:
  /// `stiffness` k [N/m] > 0, `damping` c [N s/m] >= 0, `dt` [s] is the step. Keeps references to the network and the obstacles,
  /// which are at time 0 until prepare().
  PenaltyContact(const SpringNetwork& network, const ObstacleSet& obstacles, double stiffness, double damping, double dt);

  void set_step(double dt) override { dt_ = dt; }

  [[nodiscard]] std::string name() const override { return "penalty contact"; }

  /// Takes the obstacles at `time` [s] for all following calls.
  void prepare(double time) override;
  void add(const Kinematics& at, Points& forces) const override;

  /// The derivatives for a plane at the nearest point. The change of the friction bound with the push is left out, as it is not
  /// symmetric.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  void append_elements(std::vector<LinearElement>& elements) const override;

  /// The energy k p^2 / 2 of all penetrations at the time of the last prepare() [J].
  [[nodiscard]] double energy(const Points& positions) const override;
  [[nodiscard]] EnergyKind energy_kind() const override { return EnergyKind::contact; }

  /// Particles nearer to an obstacle than their gap at that time, ascending.
  [[nodiscard]] std::vector<Index> touching(const Points& positions) const override;

  /// The normals of obstacles at these particles, at that time.
  [[nodiscard]] std::vector<ContactNormal> normals(const Points& positions) const override;

 private:
  struct Touch;
  /// Of vertices of surfaces that are nearer to an obstacle than their gap, by particle.
  [[nodiscard]] std::vector<Contact> contacts(const Points& positions) const;
  [[nodiscard]] ContactMaterial pair_of(const Contact& contact) const;
  [[nodiscard]] Touch touch(const Contact& contact, const Kinematics& at) const;

  const SpringNetwork& network_;
  ObstacleFrame obstacles_;
  double stiffness_;
  double damping_;
  double dt_;
  Scalars thickness_;
};

/// An anchor for each particle of a network, as an obstacle may touch any: a penalty connects it to the obstacle.
void append_penalty_elements(const SpringNetwork& network, double stiffness, double damping, std::vector<LinearElement>& elements);

}  // namespace sprung
