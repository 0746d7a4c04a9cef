// Gravity and air drag.
#pragma once

#include "dynamics/air/wind.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

namespace sprung {

/// m g; energy -m g . x.
class Gravity final : public Force {
 public:
  /// `acceleration` in m/s^2. Keeps a reference to the network.
  Gravity(const SpringNetwork& network, const Vector3& acceleration);
  [[nodiscard]] std::string name() const override { return "gravity"; }
  void follow(const Conditions& conditions) override { acceleration_ = conditions.gravity; }
  [[nodiscard]] bool is_constant() const override { return true; }
  void add(const Kinematics& at, Points& forces) const override;
  [[nodiscard]] double energy(const Points& positions) const override;
  [[nodiscard]] EnergyKind energy_kind() const override { return EnergyKind::gravity; }
  [[nodiscard]] double largest_acceleration() const override { return acceleration_.norm(); }

 private:
  const Scalars& masses_;
  Vector3 acceleration_;
};

/// Linear air drag, -c A (v - wind). A is the network's drag area: c is by length [kg/(m s)] for ropes, by area [kg/(m^2 s)] for
/// surfaces, and by particle [kg/s] for bodies that have neither.
class AirDrag final : public Force {
 public:
  AirDrag(const SpringNetwork& network, double drag, Wind wind);  ///< drag >= 0
  [[nodiscard]] std::string name() const override { return "air drag"; }
  void follow(const Conditions& conditions) override { wind_ = conditions.wind; }
  void add(const Kinematics& at, Points& forces) const override;
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;
  void append_elements(std::vector<LinearElement>& elements) const override;
  [[nodiscard]] double largest_acceleration() const override;

 private:
  const SpringNetwork& network_;
  double drag_;
  double rate_ = 0.0;  ///< the largest of all particles [1/s]
  Wind wind_;
};

}  // namespace sprung
