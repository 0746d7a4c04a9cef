// Estimates of a body's stiffness: how far its own weight stretches and bends it, and how long its swings take.
#pragma once

#include "network/model/spring_network.h"

namespace sprung {

/// A body as a uniform bar or sheet that hangs by one end of its longest side. Infinity where nothing resists.
struct StiffnessEstimate {
  double length = 0.0;          ///< of the longest side [m]; of a rope: its rest length
  double sag = 0.0;             ///< rho g L^2 / (2 M): how far the lower end sinks as springs stretch [m], without a stretch limit
  double stretch_period = 0.0;  ///< 4 L sqrt(rho / M): slowest motion along the length [s]
  double swing_period = 0.0;    ///< 2 pi sqrt(2 L / (3 g)): of a rigid pendulum [s]
  /// 2 (B / (rho g))^(1/3) [m]: the length that droops by 41.5 degrees (Peirce 1930); 0 without bends.
  double overhang = 0.0;
};

/// n B A with the length or area A of the body, its dimension n and the bending rigidity B: EI of a rope [N m^2], the mean of both
/// directions of a cloth [N m]. Its energy with a curvature c in all directions is half of this times c^2. 0 without bends.
[[nodiscard]] double bending_resistance(const SpringNetwork& network, const Body& body);

/// M is the modulus along the longest side that the springs have if other directions are held. Requires a body with a measure and
/// gravity > 0 [m/s^2].
[[nodiscard]] StiffnessEstimate estimate_stiffness(const SpringNetwork& network, const Body& body, double gravity);

}  // namespace sprung
