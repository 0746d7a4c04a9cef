#include "network/simulation_state.h"

namespace sprung {

SimulationState initial_state(const SpringNetwork& network) {
  return {0, network.positions, network.velocities, network.positions};
}

}  // namespace sprung
