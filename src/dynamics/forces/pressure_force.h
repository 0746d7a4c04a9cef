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

  [[nodiscard]] std::string name() const override { return "pressure"; }
  void add(const Kinematics& at, Points& forces) const override;
  [[nodiscard]] double energy(const Points& positions) const override;

  /// An anchor for each vertex, for the triangles at the positions of the network.
  void append_elements(std::vector<LinearElement>& elements) const override;

 private:
  const SpringNetwork& network_;
};

/// Whether a body of the network has a pressure.
[[nodiscard]] bool has_pressure(const SpringNetwork& network);

}  // namespace sprung
