// Stiffness and damping of elements: those of the network, or the share of them that a force has.
#pragma once

#include <vector>

namespace sprung {

struct ElementConstants {
  std::vector<double> stiffness;  ///< an entry per element; units as in Springs or AngleBends
  std::vector<double> damping;
  /// Whether dampers of angle bends become weaker where the gradients of their angles grow, so that they damp no motion faster than
  /// at rest. Those of face bends always do.
  bool bounds_damping = false;
};

}  // namespace sprung
