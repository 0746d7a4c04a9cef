// Resistance to bending by angles, of ropes, cloths and meshes.
//
// Angle bends join three particles in line. With the bonds a = x_middle - x_before, b = x_after - x_middle and n = a x b, the angle
// is theta = atan2(|n|, a . b). Its gradient turns each bond towards the other's line, at the end by 1 / length: d theta / d
// x_after = n x b /
// (|n| b^2), d theta / d x_before = n x a / (|n| a^2), and the middle has minus their sum (Bergou et al. 2008, "Discrete elastic
// rods", whose hinges these are).
//
// The energy is 1/2 k theta^2 f(a) f(b): f is 1 for bonds of at least half their rest length, and (2 |a| / rest length)^2 below, so
// that forces stay bounded where bonds collapse. Where n is 0, in line or folded back, no direction is preferred: no force.
//
// For face bends see FaceBends and `hinge_angle.h`.
#pragma once

#include "dynamics/forces/element_blocks.h"
#include "dynamics/forces/element_constants.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sprung {

/// The constants of the angle bends of a network, then those of its face bends.
[[nodiscard]] ElementConstants constants_of_bends(const SpringNetwork& network);

class BendingAngleForce final : public Force {
 public:
  /// Keeps a reference to the network.
  explicit BendingAngleForce(const SpringNetwork& network);
  /// With these constants in place of `constants_of_bends`.
  BendingAngleForce(const SpringNetwork& network, ElementConstants constants);

  [[nodiscard]] std::string name() const override { return "angle bends"; }

  /// Keeps the gradients of hinges, which take most of the time.
  void hold(const Points& positions) override;

  /// Requires the positions of the last hold(), if there was any.
  void add(const Kinematics& at, Points& forces) const override;
  void couple(std::vector<ParticlePair>& pairs) const override;

  /// Two terms. The first is k g g^T, where g is the gradient of the angle. The second acts across the plane of the bend: 1/2 k
  /// theta cot(theta / 2) w w^T with w = (1 / |a|, -1 / |a| - 1 / |b|, 1 / |b|). In the straight configuration the two are exact.
  /// Face bends have the first term alone, in which theta is F phi: it is exact at rest.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// Those of flat face bends, and of straight angle bends with weights (1/a, -1/a - 1/b, 1/b) for bonds a and b at rest. No bent
  /// configuration with such bonds has a faster mode: no weight grows, and the signs already alternate.
  void append_elements(std::vector<LinearElement>& elements) const override;

  /// sum 1/2 k theta^2 f(a) f(b) + sum 1/2 k |F phi|^2 [J]
  [[nodiscard]] double energy(const Points& positions) const override;

  /// At least the energy of bends that are all folded back [J].
  [[nodiscard]] double capacity() const override;

 private:
  struct HingeShape {
    std::array<Vector3, 4> gradient;
    double deviation;  ///< [rad]; 0 if no face resists
    double share;      ///< of dampers, at most 1: no gradient times it is longer than at rest
  };
  struct FaceSide {
    Index face = kNone;
    Index side = 0;
  };

  [[nodiscard]] bool acts(std::size_t element) const;
  void assign_faces();
  void add_bends(const Kinematics& at, Points& forces) const;
  void measure_hinges(const Points& x, HingeShape* shapes) const;
  void add_hinges(const Kinematics& at, Points& forces) const;
  void add_face_derivatives(Index face, const Points& x, ForceDerivatives& derivatives) const;

  const SpringNetwork& network_;
  ElementConstants constants_;
  std::size_t first_face_;  ///< the number of angle bends
  ElementBlocks bend_blocks_;
  ElementBlocks hinge_blocks_;
  std::vector<char> acting_faces_;  ///< by face bend: whether it has stiffness or damping, and a particle that is awake
  std::vector<std::array<FaceSide, 2>> faces_of_hinge_;  ///< by hinge, those that act
  bool faces_resist_ = false;                            ///< whether any has stiffness
  bool faces_damp_ = false;
  std::vector<HingeShape> held_;  ///< empty until hold()
};

}  // namespace sprung
