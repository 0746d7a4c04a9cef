#include "network/simulation_state.h"

namespace sprung {

SimulationState initial_state(const SpringNetwork& network) {
  return {.x = network.positions,
          .v = network.velocities,
          .x_previous = network.positions,
          .stretch_handovers = std::vector<StretchHandover>(network.bodies.size())};
}

}  // namespace sprung
