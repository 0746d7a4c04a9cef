#include "network/model/simulation_state.h"

#include "network/model/spring_network.h"

namespace sprung {

SimulationState initial_state(const SpringNetwork& network) {
  return {.x = network.positions,
          .v = network.velocities,
          .x_previous = network.positions,
          .slip = {.displacement = Points::Zero(3, network.positions.cols()),
                   .obstacle = std::vector<Index>(static_cast<std::size_t>(network.positions.cols()), kNone)},
          .stretch_handovers = std::vector<StretchHandover>(network.bodies.size())};
}

}  // namespace sprung
