// Finds out which bodies have come to rest, so that they can sleep.
//
// The rule is that of rigid bodies in games (Catto, Box2D; Rouwe, Jolt): a body that was slow for half a second is at rest. A speed
// is slow up to the one that gravity gives in a millisecond, 1 cm/s on earth.
#pragma once

#include "network/model/simulation_state.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

class RestDetector {
 public:
  /// Keeps a reference to the network. `gravity` in m/s^2.
  RestDetector(const SpringNetwork& network, double gravity);

  /// Call it after each step, at `time` [s]. Compares the positions of each body that is awake with those at the beginning of a
  /// window of half a second. A free particle may move by a slow speed times half a second, and by a quarter of the body's shortest
  /// spring; farther, and a new window begins. At the end of a window, BodyRest::rests is set if the root mean square of the
  /// displacements is at most a tenth of that bound, and the root mean square of the speeds is slow and did not grow: a body that
  /// begins to slide or to fall over is slow at first. Then the next window begins.
  void note(double time, SimulationState& state) const;

 private:
  struct Watched {
    std::vector<Index> free;  ///< particles that are not pinned
    double longest;           ///< displacement at rest [m]
  };
  void note(const Watched& body, double time, SimulationState& state, BodyRest& rest) const;

  double slow_;                  ///< [m/s]
  std::vector<Watched> bodies_;  ///< without free particles: bodies that sleep or that pins hold as a whole
};

}  // namespace sprung
