// The dampers of angle bends as a force of their own, for several evaluations at the same positions.
#pragma once

#include "dynamics/forces/element_blocks.h"
#include "dynamics/forces/force.h"

#include <vector>

namespace sprung {

/// c d theta / dt on each angle bend (see bending_angle_force.h). A damper becomes weaker where the gradient of its angle grows,
/// with 1 / length, so that it damps no motion faster than at rest.
class AngleDampers final : public Force {
 public:
  /// `damping` [N m s] has an entry for each angle bend. Keeps a reference to the network.
  AngleDampers(const SpringNetwork& network, std::vector<double> damping);

  void hold(const Points& positions) override;

  /// Requires the positions of the last hold().
  void add(const Kinematics& at, Points& forces) const override;

 private:
  struct HeldDamper {
    Vector3 turn_before;  ///< gradient of the angle at `before` [1/m]
    Vector3 turn_after;
    double damping;  ///< [N m s], with its share
    double fullness;
  };

  const SpringNetwork& network_;
  std::vector<double> damping_;
  ElementBlocks blocks_;
  std::vector<HeldDamper> held_;
};

}  // namespace sprung
