// The pressure of a gas in closed bodies.
#pragma once

#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

namespace sprung {

/// A constant excess pressure p [Pa] in a closed body pushes each triangle along its outward normal by p times its area, a third of
/// it at each corner. The energy is -p V with the enclosed volume V.
class PressureForce final : public Force {
 public:
  /// Of all bodies with a pressure (Body::pressure). Keeps a reference to the network.
  explicit PressureForce(const SpringNetwork& network) : network_(network) {}

  void add(const Kinematics& at, Points& forces) const override;
  [[nodiscard]] double energy(const Points& positions) const override;

  /// An upper bound of the largest eigenvalue of M^-1 dF/dx at the positions of the network [1/s^2].
  [[nodiscard]] double largest_eigenvalue() const;

 private:
  const SpringNetwork& network_;
};

/// Whether a body of the network has a pressure.
[[nodiscard]] bool has_pressure(const SpringNetwork& network);

}  // namespace sprung
