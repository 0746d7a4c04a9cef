#include "network/simulation_state.h"

namespace sprung {

SimulationState initial_state(const SpringNetwork& network) {
  return {.x = network.positions,
          .v = network.velocities,
          .x_previous = network.positions,
          .slip = Points::Zero(3, network.positions.cols()),
          .stretch_handovers = std::vector<StretchHandover>(network.bodies.size())};
}

}  // namespace sprung
