// Pins: particles that follow a prescribed motion or an obstacle.
#pragma once

#include "base/types.h"
#include "geometry/motion/motion.h"

#include <limits>
#include <string>
#include <vector>

namespace sprung {

/// Particles that follow a prescribed motion or an obstacle. With the default motion they rest. A pin that begins after time 0
/// takes its particles at their positions at that time. Then it moves them by the change of its pose since. A simulator rounds both
/// times to steps.
struct Pin {
  std::vector<Index> particles{};    ///< of the network
  Vector3 origin = Vector3::Zero();  ///< origin of the rotation [m]
  Motion motion{};
  Index obstacle = kNone;  ///< of the simulator, which the particles follow instead of `motion`; kNone: none
  double from = 0.0;       ///< when it takes its particles [s], >= 0
  double until = std::numeric_limits<double>::infinity();  ///< when it lets go of them [s], > from
  std::string name{};  ///< under which its force is reported; NetworkBuilder gives `pins[k]` to its pin k if it has none

  [[nodiscard]] bool moves() const { return obstacle != kNone || motion.moves(); }
  [[nodiscard]] bool holds_always() const { return from == 0.0 && until == std::numeric_limits<double>::infinity(); }
};

/// Whether both pins have the same name and particles, and begin and end at the same times.
[[nodiscard]] inline bool are_alike(const Pin& a, const Pin& b) {
  return a.name == b.name && a.particles == b.particles && a.from == b.from && a.until == b.until;
}

}  // namespace sprung
