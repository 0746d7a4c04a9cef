// Resistance to bending by angles, of ropes and cloths.
//
// With the bonds a = x_middle - x_before, b = x_after - x_middle and n = a x b, the angle is theta = atan2(|n|, a . b). Its
// gradient turns each bond towards the other's line, at the end by 1 / length: d theta / d x_after = n x b / (|n| b^2), d theta / d
// x_before = n x a / (|n| a^2), and the middle has minus their sum (Bergou et al. 2008, "Discrete elastic rods", whose hinges these
// are).
//
// The energy is 1/2 k theta^2 f(a) f(b): f is 1 for bonds of at least half their rest length, and (2 |a| / rest length)^2 below, so
// that forces stay bounded where bonds collapse. Where n is 0, in line or folded back, no direction is preferred: no force.
#pragma once

#include "dynamics/forces/element_constants.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

#include <memory>
#include <vector>

namespace sprung {

class BendingAngleForce final : public Force {
 public:
  /// Keeps a reference to the network.
  explicit BendingAngleForce(const SpringNetwork& network);
  /// With these constants in place of those of the network's angle bends.
  BendingAngleForce(const SpringNetwork& network, ElementConstants constants);

  [[nodiscard]] std::string name() const override { return "angle bends"; }
  void add(const Kinematics& at, Points& forces) const override;
  void couple(std::vector<ParticlePair>& pairs) const override;

  /// Two terms. The first is k g g^T, where g is the gradient of the angle. The second acts across the plane of the bend: 1/2 k
  /// theta cot(theta / 2) w w^T with w = (1 / |a|, -1 / |a| - 1 / |b|, 1 / |b|). In the straight configuration the two are exact.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// Those of straight bends, with weights (1/a, -1/a - 1/b, 1/b) for bonds a and b at rest. No bent configuration with such bonds
  /// has a faster mode: no weight grows, and the signs already alternate.
  void append_elements(std::vector<LinearElement>& elements) const override;

  /// sum 1/2 k theta^2 f(a) f(b) [J]
  [[nodiscard]] double energy(const Points& positions) const override;

  /// sum 1/2 k pi^2 [J], of bends that are folded back
  [[nodiscard]] double capacity() const override;

 private:
  void assign_blocks();

  const SpringNetwork& network_;
  std::unique_ptr<const ElementConstants> own_;  ///< null: those of the network
  const std::vector<double>& stiffness_;         ///< k and damping of each element
  const std::vector<double>& damping_;
  std::vector<std::vector<Index>> blocks_;  ///< elements that touch each block of particles
};

}  // namespace sprung
