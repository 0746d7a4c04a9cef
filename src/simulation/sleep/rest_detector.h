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

  /// Compares the positions of each body that is awake after a step, at `time` [s], with those at the beginning of a window of half
  /// a second. BodyRest::rests is set at the end of a window if the root mean square of the displacements is a tenth of the largest
  /// at rest, and that of the speeds is slow and did not grow: what begins to slide or to fall over is slow at first. A new window
  /// begins then, and whenever a body of the island is driven or has moved: a free particle is farther than a slow motion takes it
  /// in half a second, or than a quarter of the body's shortest spring. So whoever just lost its support does not count as at rest.
  void note(double time, const std::vector<char>& driven, const std::vector<Index>& islands, SimulationState& state) const;

 private:
  struct Watched {
    std::vector<Index> free;  ///< particles that are not pinned
    double longest;           ///< displacement at rest [m]
  };
  [[nodiscard]] static bool has_moved(const Watched& body, const SimulationState& state);
  void begin_window(const Watched& body, double time, SimulationState& state, BodyRest& rest) const;
  void end_window(const Watched& body, double time, SimulationState& state, BodyRest& rest) const;

  double slow_;                  ///< [m/s]
  std::vector<Watched> bodies_;  ///< without free particles: bodies that sleep or that pins hold as a whole
};

}  // namespace sprung
