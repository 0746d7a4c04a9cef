// Stiffness and damping of elements: those of the network, or the share of them that a force has.
#pragma once

#include <vector>

namespace sprung {

struct ElementConstants {
  std::vector<double> stiffness;  ///< an entry per element; units as in Springs or AngleBends
  std::vector<double> damping;
};

}  // namespace sprung
