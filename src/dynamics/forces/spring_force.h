// Spring-damper forces (eq. 5-12 of the lab manual).
//
// With s = p1 - p2, e = s / |s|, v1e = e . v1, v2e = e . v2, particle 1 feels
//     F = ( -k_s (|s| - d) - k_d (v1e - v2e) ) e
// and particle 2 feels -F. Erratum: the manual prints the elastic part as -k_s (d - |s|) along e (eq. 7, 10, 11), which would push
// a stretched spring further apart; its own code applies the sign used here. |s| = 0 gives no force, nor does |s| <= d if the
// spring is tension_only.
#pragma once

#include "dynamics/forces/element_constants.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

#include <memory>

namespace sprung {

struct SpringPlan;

class SpringForce final : public Force {
 public:
  /// Keeps a reference to the network. Rest lengths of springs that yield may change later.
  explicit SpringForce(const SpringNetwork& network);
  /// With these constants in place of those of the network's springs.
  SpringForce(const SpringNetwork& network, ElementConstants constants);
  ~SpringForce() override;

  [[nodiscard]] std::string name() const override { return "springs"; }

  [[nodiscard]] bool is_constant() const override;

  void add(const Kinematics& at, Points& forces) const override;

  void couple(std::vector<ParticlePair>& pairs) const override;

  /// On particle 1: by its position -k_s (e e^T + max(0, 1 - d / |s|) (I - e e^T)) (Baraff and Witkin 1998), by its velocity -k_d
  /// e e^T. The rotation of the damper's direction is left out, as it is not symmetric.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// A pair for each spring: no spring that is not compressed is stiffer in any direction.
  void append_elements(std::vector<LinearElement>& elements) const override;

  /// sum 1/2 k_s (|s| - d)^2 [J], without springs that are slack
  [[nodiscard]] double energy(const Points& positions) const override;

  /// sum 1/2 k_s d^2 [J], of springs at twice their rest length
  [[nodiscard]] double capacity() const override;

 private:
  const SpringNetwork& network_;
  std::unique_ptr<const ElementConstants> own_;  ///< null: those of the network
  const std::vector<double>& stiffness_;         ///< k_s and k_d of each spring
  const std::vector<double>& damping_;
  std::unique_ptr<const SpringPlan> plan_;
};

}  // namespace sprung
