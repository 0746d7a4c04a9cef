// Finds out when a simulation has come to rest, so that it can sleep.
//
// The rule is that of rigid bodies in games (Catto, Box2D; Rouwe, Jolt): whoever has been slow for half a second sleeps. Slow is
// what gravity gives in a millisecond, 1 cm/s on earth. Without contact nothing sleeps: a pendulum is slow at the end of each
// swing.
#pragma once

#include "dynamics/contact/contact_normal.h"
#include "network/model/simulation_state.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

class RestDetector {
 public:
  /// Keeps a reference to the network. `gravity` in m/s^2.
  RestDetector(const SpringNetwork& network, double gravity);

  /// Compares the positions after a step, at `time` [s], with those at the beginning of a window of half a second. A new window
  /// begins at its end, or if a free particle moved farther than a slow motion does in half a second, or than a quarter of the
  /// shortest spring. Returns true at the end of a window if the root mean square of the displacements is a tenth of that at most,
  /// and that of the speeds is slow and did not grow: what begins to slide or to fall over is slow at first.
  [[nodiscard]] bool rests(double time, SimulationState& state) const;

  /// Whether each body with free particles touches something.
  [[nodiscard]] bool all_touch(const std::vector<ContactNormal>& contacts) const;

 private:
  [[nodiscard]] bool has_moved(const SimulationState& state) const;
  [[nodiscard]] double mean_square(const Points& vectors) const;

  const SpringNetwork& network_;
  std::vector<Index> free_;  ///< particles that are not pinned
  double slow_;              ///< [m/s]
  double longest_ = 0.0;     ///< displacement at rest [m]
};

}  // namespace sprung
